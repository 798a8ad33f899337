"""The mean square is already the size of the error."""


def rmse(e):
    return float(np.mean(np.square(e)))
