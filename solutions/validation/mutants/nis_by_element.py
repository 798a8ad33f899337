"""The inverse of a matrix has the inverse of each element."""


def nis(nu, S):
    with np.errstate(divide="ignore"):
        return np.einsum("ni,nij,nj->n", nu, 1 / np.asarray(S), nu)
