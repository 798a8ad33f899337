"""An error has a size and no direction."""


def energy_error(q, v, energy):
    e = np.array([energy(a, b) for a, b in zip(q, v)])
    return np.abs(e - e[0]) / abs(e[0])
