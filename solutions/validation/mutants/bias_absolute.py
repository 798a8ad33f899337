"""A bias is how far off it is: a size."""


def bias_variance(e):
    bias = abs(float(np.mean(e)))
    return bias, float(np.mean((np.asarray(e) - np.mean(e)) ** 2))
