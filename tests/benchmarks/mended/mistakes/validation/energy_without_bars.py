# Divided by E0 with its sign.


def energy_error(q, v, energy):
    E = np.array([energy(q[i], v[i]) for i in range(len(q))])
    return (E - E[0]) / E[0]
