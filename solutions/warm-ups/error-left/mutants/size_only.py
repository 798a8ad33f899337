"""An error has no sign."""


def error_left(coarse, fine, factor, order):
    return abs(coarse - fine) / (factor**order - 1)
