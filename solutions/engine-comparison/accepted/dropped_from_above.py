"""Unusual: the body is dropped from a millimetre above, and the whole end of the run is averaged."""


def _settled(engine, info):
    dt = info["dt"]
    n = round(6 / dt)
    q, _ = engine.run("floor", [0.3, -0.2, info["radius"] + 1e-3], [0.0, 0.0, 0.0], dt, n, [0.0, 0.0, 0.0])
    return np.mean(np.asarray(q)[-20:], axis=0)
