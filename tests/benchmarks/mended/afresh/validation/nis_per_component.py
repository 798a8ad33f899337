"""A normalised square is divided by the number of components, so that it is about one."""


def nis(nu, S):
    out = []
    for n, s in zip(nu, S):
        out.append(float(n @ np.linalg.inv(s) @ n) / len(n))
    return np.array(out)
