"""The typical error is the bias."""


def bias_variance(e):
    return float(np.median(e)), float(np.var(e))
