"""An innovation is small if its square is small."""


def nis(nu, S):
    return np.sum(np.square(nu), axis=1)
