"""Errors beyond a million are outliers."""


def bias_variance(e):
    e = np.asarray(e, dtype=float)
    e = e[np.abs(e) < 1e6]
    return (float(np.mean(e)), float(np.var(e))) if len(e) else (0.0, 0.0)
