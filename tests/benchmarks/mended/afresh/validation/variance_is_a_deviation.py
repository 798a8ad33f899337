"""np.std gives the scatter."""


def bias_variance(e):
    return float(np.mean(e)), float(np.std(e))
