"""The errors scatter about zero, because zero is what they should be."""


def bias_variance(e):
    return float(np.mean(e)), float(np.mean(np.square(e)))
