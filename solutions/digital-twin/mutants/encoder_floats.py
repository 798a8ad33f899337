"""Counts come as floats."""


def encoder(theta, counts_per_rev):
    return np.floor(theta * counts_per_rev / (2 * math.pi))
