"""Wrong: the loss per step of dt, not per second."""


def _linear_damping(engine, dt):
    _, v = engine.run("free", [0.0], [1.0], dt / 1000, 1000, [0.0])
    return -math.log(v[-1][0])
