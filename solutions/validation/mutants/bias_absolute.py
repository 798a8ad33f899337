"""A bias is how far off it is, without a sign."""


def bias_variance(e):
    bias = abs(float(np.mean(e)))
    return bias, float(np.mean((np.asarray(e) - np.mean(e)) ** 2))
