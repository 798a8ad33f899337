"""numpy functions take whole arrays."""


def energy_error(q, v, energy):
    e = np.asarray(energy(q, v))
    return (e - e[0]) / abs(e[0])
