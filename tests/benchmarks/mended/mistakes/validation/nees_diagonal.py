# Only the diagonal of the covariance is looked at.


def nees(err, P):
    err, P = np.asarray(err, dtype=float), np.asarray(P, dtype=float)
    return np.sum(err**2 / np.diagonal(P, axis1=1, axis2=2), axis=1)
