"""Weighting by a covariance is multiplying by it."""


def nees(err, P):
    return np.einsum("ni,nij,nj->n", err, P, err)
