"""The starts are spread over dt metres, not over v dt."""


def _tunnelling_speed(engine, info):
    dt = info["dt"]

    def stopped(speed):
        n = math.ceil(2 / (speed * dt)) + 2
        for start in np.linspace(-1 - dt, -1, 31):
            q, _ = engine.run("wall", [start], [speed], dt, n, [0])
            if q[-1][0] > 0:
                return False
        return True

    if stopped(199.9):
        return math.inf
    return _bisect(stopped, 1.0, 199.9, 0.1)
