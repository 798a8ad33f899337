"""The exact result is asked for."""


def error_left(coarse, fine, factor, order):
    return fine - (coarse - fine) / (factor**order - 1)
