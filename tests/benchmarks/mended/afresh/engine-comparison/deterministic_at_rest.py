"""Two runs of a body that stands still."""


def _deterministic(engine, dt):
    q1, v1 = engine.run("free", [0.0], [0.0], dt, 100, [0.0])
    q2, v2 = engine.run("free", [0.0], [0.0], dt, 100, [0.0])
    return bool(np.array_equal(q1, q2) and np.array_equal(v1, v2))
