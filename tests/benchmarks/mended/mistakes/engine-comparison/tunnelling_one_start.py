# One start for each speed.


def _tunnelling_speed(engine, info):
    dt = info["dt"]

    def stopped(speed):
        n = math.ceil(4 / (speed * dt)) + 2
        q, _ = engine.run("wall", [-1.0], [speed], dt, n, [0])
        return q[-1][0] < 0

    if stopped(199.9):
        return math.inf
    return _bisect(stopped, 1.0, 199.9, 0.1)
