"""A turn has 360."""


def encoder(theta, counts_per_rev):
    return np.floor(np.asarray(theta) * counts_per_rev / 360.0).astype(np.int64)
