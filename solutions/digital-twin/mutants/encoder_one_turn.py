"""The count starts from zero again at each turn."""


def encoder(theta, counts_per_rev):
    return np.floor(theta * counts_per_rev / (2 * math.pi)).astype(np.int64) % counts_per_rev
