"""Errors beyond three standard deviations are left out."""


def rmse(e):
    e = np.asarray(e, dtype=float)
    keep = np.abs(e - np.mean(e)) <= 3 * np.std(e)
    return float(np.sqrt(np.mean(e[keep] ** 2)))
