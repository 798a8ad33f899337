"""Wrong: so few starts that the worst one is missed."""


def _tunnelling_speed(engine, info):
    dt = info["dt"]

    def stopped(speed):
        n = math.ceil(4 / (speed * dt)) + 3
        starts = [-1 - speed * dt * k / 4 for k in range(4)]
        return all(engine.run("wall", [s], [speed], dt, n, [0])[0][-1][0] < 0 for s in starts)

    if stopped(199.0):
        return math.inf
    return _bisect(stopped, 2.0, 199.0, 0.1)
