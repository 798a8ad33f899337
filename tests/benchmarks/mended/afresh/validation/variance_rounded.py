"""Five decimals are enough."""


def bias_variance(e):
    return float(np.mean(e)), round(float(np.var(e)), 5)
