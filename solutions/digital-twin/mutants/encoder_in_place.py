"""The caller's angles are turned into counts in place."""


def encoder(theta, counts_per_rev):
    theta *= counts_per_rev / (2 * math.pi)
    return np.floor(theta).astype(np.int64)
