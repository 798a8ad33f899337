"""Wrong: the rate of the energy, twice that of the speed."""


def _linear_damping(engine, dt):
    _, v = engine.run("free", [0.0], [1.0], dt / 1000, 100, [0.0])
    return -math.log(v[-1][0] ** 2) / (dt / 10)
