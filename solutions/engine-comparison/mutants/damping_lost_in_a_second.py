"""Wrong: the fraction of the speed that is lost in one second is given as the rate."""


def _linear_damping(engine, dt):
    n = 1000
    _, v = engine.run("free", [0.0], [1.0], 1 / n, n, [0.0])
    return 1 - v[-1][0]
