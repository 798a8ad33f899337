"""Wrong: one step shows whether a body gets through."""


def _tunnelling_speed(engine, info):
    dt = info["dt"]

    def stopped(speed):
        starts = [-1 - speed * dt * k / 16 for k in range(16)]
        return all(engine.run("wall", [s], [speed], dt, 1, [0])[0][-1][0] < 0 for s in starts)

    if stopped(50.0):
        return math.inf
    return _bisect(stopped, 2.0, 199.0, 0.1)
