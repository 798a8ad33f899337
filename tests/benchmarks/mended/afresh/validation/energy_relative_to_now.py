"""Relative to the energy of the sample itself."""


def energy_error(q, v, energy):
    E = np.array([energy(a, b) for a, b in zip(q, v)])
    return (E - E[0]) / np.abs(E)
