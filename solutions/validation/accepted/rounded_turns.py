"""Subtracts the nearest whole number of turns; squared distances by Cholesky factors."""


def wrap_angle(e):
    e = np.array(e, dtype=float)
    e -= 2 * np.pi * np.round(e / (2 * np.pi))  # a copy, so the caller's angles stay
    return e


def nees(err, P):
    factor = np.linalg.cholesky(P)
    whitened = np.linalg.solve(factor, np.asarray(err)[..., None])[..., 0]
    return (whitened**2).sum(axis=1).tolist()


def nis(nu, S):
    return np.einsum("ni,nij,nj->n", nu, np.linalg.inv(S), nu)
