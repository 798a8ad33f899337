"""Variance and standard deviation are two words for one thing."""


def bias_variance(e):
    return float(np.mean(e)), float(np.std(e))
