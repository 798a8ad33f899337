"""Every variance divides by N - 1."""


def bias_variance(e):
    return float(np.mean(e)), float(np.var(e, ddof=1))
