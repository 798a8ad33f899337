"""Counts are truncated toward zero."""


def encoder(theta, counts_per_rev):
    return (theta * counts_per_rev / (2 * math.pi)).astype(np.int64)
