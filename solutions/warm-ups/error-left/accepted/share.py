"""The share that is left, times the change."""


def error_left(coarse, fine, factor, order):
    left = factor ** (-order)
    return (coarse - fine) * left / (1 - left)
