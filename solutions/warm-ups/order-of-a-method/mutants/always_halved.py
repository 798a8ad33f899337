"""Takes every step as halved."""


def observed_order(h, error, h_small, error_small):
    return math.log2(error / error_small)
