"""The change is the error of the coarse run."""


def error_left(coarse, fine, factor, order):
    return (coarse - fine) / factor**order
