"""e -= mean is the same as e = e - mean."""


def bias_variance(e):
    bias = float(np.mean(e))
    e -= bias
    return bias, float(np.mean(e**2))
