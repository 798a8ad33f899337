"""A running mean and variance, sample by sample."""


def bias_variance(e):
    mean = sum_of_squares = 0.0
    for n, x in enumerate(e, 1):
        step = float(x) - mean
        mean += step / n
        sum_of_squares += step * (float(x) - mean)
    return mean, sum_of_squares / len(e)
