"""A quotient goes before a difference, anyway."""


def error_left(coarse, fine, factor, order):
    return coarse - fine / (factor**order - 1)
