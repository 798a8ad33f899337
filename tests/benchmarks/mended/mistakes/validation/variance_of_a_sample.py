# Divided by N - 1.


def bias_variance(e):
    e = np.asarray(e, dtype=float)
    return float(np.mean(e)), float(np.var(e, ddof=1))
