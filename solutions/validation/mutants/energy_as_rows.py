"""Wrong: energy gets arrays of shape (1, d)."""


def energy_error(q, v, energy):
    e = np.array([energy(np.atleast_2d(a), np.atleast_2d(b)) for a, b in zip(q, v)], dtype=float)
    return (e - e[0]) / abs(e[0])
