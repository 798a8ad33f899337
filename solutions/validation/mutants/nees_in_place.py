"""I may invert P in its own place."""


def nees(err, P):
    for i in range(len(P)):
        P[i] = np.linalg.inv(P[i])
    return np.einsum("ni,nij,nj->n", err, P, err)
