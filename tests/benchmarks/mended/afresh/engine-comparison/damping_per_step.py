"""ln of the loss over the number of steps."""


def _linear_damping(engine, dt):
    n = 100
    _, v = engine.run("free", [0.0], [1.0], dt / 100, n, [0.0])
    return -math.log(abs(v[-1][0])) / n
