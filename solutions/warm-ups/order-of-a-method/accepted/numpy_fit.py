"""A straight line through two points."""


def observed_order(h, error, h_small, error_small):
    import numpy as np

    return float(np.polyfit(np.log([h, h_small]), np.log([error, error_small]), 1)[0])
