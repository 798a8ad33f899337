# The distance and not its square.


def nis(nu, S):
    nu, S = np.asarray(nu, dtype=float), np.asarray(S, dtype=float)
    return np.array([np.sqrt(x @ np.linalg.inv(C) @ x) for x, C in zip(nu, S)])
