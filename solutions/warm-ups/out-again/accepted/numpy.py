"""With NumPy's clip."""


def push_out(depth, h, beta, slop):
    import numpy as np

    return float(np.clip(depth - slop, 0.0, None) * beta / h)
