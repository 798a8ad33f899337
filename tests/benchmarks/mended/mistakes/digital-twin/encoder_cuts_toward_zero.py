# Cut off toward zero.


def encoder(theta, counts_per_rev):
    return (np.asarray(theta) * counts_per_rev / (2 * math.pi)).astype(np.int64)
