"""Wrong: a run longer than an engine allows."""


def _linear_damping(engine, dt):
    _, v = engine.run("free", [0.0], [1.0], dt / 1e7, 1_000_000, [0.0])
    return -math.log(v[-1][0]) / (0.1 * dt)
