"""Wrong: the energy after one step instead of the area."""

_characterise = characterise


def characterise(engine):
    omega = engine.info()["omega"]
    q, v = engine.run("spring", [1.0], [0.4 * omega], 0.5 / omega, 1, [0.0])
    energy = [x[0] ** 2 + (y[0] / omega) ** 2 for x, y in zip(q, v)]
    return {**_characterise(engine), "symplectic": bool(abs(energy[1] / energy[0] - 1) < 1e-6)}
