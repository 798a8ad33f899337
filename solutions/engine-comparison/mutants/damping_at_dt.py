"""Wrong: the damping at the engine's own step, not in the limit."""


def _linear_damping(engine, dt):
    _, v = engine.run("free", [0.0], [1.0], dt, 20, [0.0])
    return -math.log(v[-1][0]) / (20 * dt)
