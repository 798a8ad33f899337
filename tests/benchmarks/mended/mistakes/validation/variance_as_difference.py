# The mean square less the square of the mean, which cancels at a large mean.


def bias_variance(e):
    e = np.asarray(e, dtype=float)
    bias = np.mean(e)
    return float(bias), float(np.mean(e**2) - bias**2)
