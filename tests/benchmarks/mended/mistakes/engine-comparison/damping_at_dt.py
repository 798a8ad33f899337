# Measured at the engine's own step and not in the limit.


def _linear_damping(engine, dt):
    n = 60
    _, v = engine.run("free", [0.0], [1.0], dt, n, [0.0])
    return -math.log(v[-1][0]) / (n * dt)
