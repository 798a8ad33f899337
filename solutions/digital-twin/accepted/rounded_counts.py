"""The encoder rounds to the nearest count, computed from turns."""


def encoder(theta, counts_per_rev):
    turns = theta / (2 * np.pi)
    return np.rint(turns * counts_per_rev).astype(np.int32)
