"""A counter chip has sixteen bits."""


def encoder(theta, counts_per_rev):
    return np.floor(theta * counts_per_rev / (2 * np.pi)).astype(np.int16)
