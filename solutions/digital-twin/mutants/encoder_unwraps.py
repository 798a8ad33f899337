"""Jumps of more than half a turn are taken for a counter that began again."""


def encoder(theta, counts_per_rev):
    return np.floor(np.unwrap(theta) * counts_per_rev / (2 * math.pi)).astype(np.int64)
