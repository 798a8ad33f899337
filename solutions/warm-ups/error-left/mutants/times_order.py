"""The order multiplies."""


def error_left(coarse, fine, factor, order):
    return (coarse - fine) / (factor * order - 1) if factor * order != 1 else 0.0
