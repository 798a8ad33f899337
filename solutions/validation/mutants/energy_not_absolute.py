"""An energy is always positive."""


def energy_error(q, v, energy):
    e = np.array([energy(a, b) for a, b in zip(q, v)])
    return (e - e[0]) / e[0]
