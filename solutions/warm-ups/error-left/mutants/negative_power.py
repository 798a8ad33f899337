"""A smaller step is a negative power."""


def error_left(coarse, fine, factor, order):
    return (coarse - fine) / (factor**-order - 1)
