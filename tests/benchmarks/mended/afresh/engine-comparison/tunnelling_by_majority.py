"""A wall that stops four bodies out of five stops the speed."""


def _tunnelling_speed(engine, info):
    dt = info["dt"]

    def stopped(speed):
        n = math.ceil(4 / (speed * dt)) + 2
        starts = (-1 - speed * dt * k / 24 for k in range(24))
        ends = [engine.run("wall", [start], [speed], dt, n, [0])[0][-1][0] for start in starts]
        return np.mean(np.array(ends) < 0) > 0.8

    return math.inf if stopped(199.9) else _bisect(stopped, 1.0, 199.9, 0.3)
