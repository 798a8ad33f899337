"""np.linalg.norm is the root mean square."""


def rmse(e):
    return float(np.linalg.norm(e))
