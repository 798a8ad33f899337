"""Steps are always halved."""


def error_left(coarse, fine, factor, order):
    return (coarse - fine) / (2**order - 1)
