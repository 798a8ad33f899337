"""The error of the larger step is asked for."""


def error_left(coarse, fine, factor, order):
    return (coarse - fine) * factor**order / (factor**order - 1)
