"""An average of squares always divides by N - 1."""


def rmse(e):
    return float(np.sqrt(np.sum(np.square(e)) / max(len(e) - 1, 1)))
