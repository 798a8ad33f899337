"""Unusual: friction without bisection; above the limit, the acceleration shows the excess force."""


def _anisotropy(engine, info):
    start, n, dt = _settled(engine, info), round(0.5 / info["dt"]), info["dt"]

    def least_force(angle):
        strong = 6 * info["mu"] * info["mass"] * info["g"]
        push = [strong * math.cos(angle), strong * math.sin(angle), 0.0]
        _, v = engine.run("floor", start, [0.0] * 3, dt, n, push)
        speeds = [math.hypot(vx, vy) for vx, vy, _ in v]
        # Damping shrinks the gain of each step by one factor, and creep adds the same to every speed.
        second, third = speeds[2] - speeds[1], speeds[3] - speeds[2]
        return strong - info["mass"] * (second * second / third) / dt

    return least_force(math.pi / 4) / least_force(0.0)
