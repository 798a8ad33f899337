"""The energies go into an array of the type of q, which cuts them off where q is of whole numbers."""


def energy_error(q, v, energy):
    e = np.empty(len(q), dtype=np.asarray(q).dtype)
    for i in range(len(e)):
        e[i] = energy(q[i], v[i])
    return (e - e[0]) / abs(e[0])
