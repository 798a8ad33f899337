"""Wrong: stable taken for symplectic."""

_characterise = characterise


def characterise(engine):
    omega = engine.info()["omega"]
    radius = max(abs(np.linalg.eigvals(_spring_step(engine, omega, 0.5))))
    return {**_characterise(engine), "symplectic": bool(radius <= 1 + 1e-6)}
