"""A straight line through the plain numbers."""


def observed_order(hs, errors):
    return np.polyfit(hs, errors, 1)[0]
