"""Wrong: one start for each speed."""


def _tunnelling_speed(engine, info):
    dt = info["dt"]

    def stopped(speed):
        q, _ = engine.run("wall", [-1.0], [speed], dt, math.ceil(4 / (speed * dt)) + 2, [0])
        return q[-1][0] < 0

    speeds = np.geomspace(2.0, 199.0, 120)
    safe = [speed for speed in speeds if stopped(speed)]
    return math.inf if len(safe) == len(speeds) else float(next(s for s in speeds if not stopped(s)))
