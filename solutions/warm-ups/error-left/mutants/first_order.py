"""Every method is of first order."""


def error_left(coarse, fine, factor, order):
    return (coarse - fine) / (factor - 1)
