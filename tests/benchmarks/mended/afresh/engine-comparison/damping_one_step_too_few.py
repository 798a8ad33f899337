"""Fifty steps are forty-nine intervals."""


def _linear_damping(engine, dt):
    h, n = dt / 10, 50
    _, v = engine.run("free", [0.0], [1.0], h, n, [0.0])
    return -math.log(v[-1][0]) / ((n - 1) * h)
