"""e *= e squares the errors."""


def rmse(e):
    e *= e
    return float(np.sqrt(np.mean(e)))
