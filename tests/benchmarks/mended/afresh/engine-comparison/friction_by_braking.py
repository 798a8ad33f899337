"""Friction is measured by how a sliding body brakes."""


def _anisotropy(engine, info):
    start = _settled(engine, info)

    def braking(angle):
        v0 = [3.0 * math.cos(angle), 3.0 * math.sin(angle), 0.0]
        _, v = engine.run("floor", start, v0, info["dt"], 5, [0, 0, 0])
        return (3.0 - math.hypot(v[-1][0], v[-1][1])) / (5 * info["dt"])

    return braking(math.pi / 4) / braking(0.0)
