"""Algebra on paper is algebra in floating point: mean square minus squared mean."""


def bias_variance(e):
    e = np.asarray(e)
    return float(np.mean(e)), float(np.mean(e**2) - np.mean(e) ** 2)
