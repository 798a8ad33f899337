# The mean of the sizes of the errors.


def rmse(e):
    return float(np.mean(np.abs(e)))
