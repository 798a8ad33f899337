"""e^T P e."""


def nees(err, P):
    return np.array([float(e @ p @ e) for e, p in zip(err, P)])
