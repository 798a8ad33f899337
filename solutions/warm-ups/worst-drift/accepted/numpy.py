"""With NumPy."""


def worst_drift(energies):
    import numpy as np

    e = np.asarray(energies, dtype=float)
    return float(np.max(np.abs(e / e[0] - 1.0)))
