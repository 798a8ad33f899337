"""Wrong: differences below a tolerance are ignored."""


def _deterministic(engine, dt):
    first, second = (engine.run("spring", [1.0], [0.5], dt, 50, [0.0]) for _ in range(2))
    return bool(np.allclose(first, second))
