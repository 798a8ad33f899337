"""The run is twice as long as the time that its loss is divided by."""


def _linear_damping(engine, dt):
    h, n = dt / 1000, 100
    _, v = engine.run("free", [0.0], [1.0], h, 2 * n, [0.0])
    return -math.log(v[-1][0]) / (n * h)
