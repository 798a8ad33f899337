"""Energy is conserved if no step changes it much."""


def energy_error(q, v, energy):
    e = np.array([energy(a, b) for a, b in zip(q, v)])
    return np.diff(e, prepend=e[0]) / abs(e[0])
