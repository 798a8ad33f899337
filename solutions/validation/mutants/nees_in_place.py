"""P is mine to invert."""


def nees(err, P):
    for i in range(len(P)):
        P[i] = np.linalg.inv(P[i])
    return np.einsum("ni,nij,nj->n", err, P, err)
