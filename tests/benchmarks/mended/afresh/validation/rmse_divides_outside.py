"""The root of the sum, over N."""


def rmse(e):
    e = np.asarray(e)
    return float(np.sqrt(np.sum(e**2)) / len(e))
