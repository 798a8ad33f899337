"""The standard deviation of the errors is their root mean square."""


def rmse(e):
    return float(np.std(e))
