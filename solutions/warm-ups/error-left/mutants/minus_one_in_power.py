"""The minus one belongs to the order."""


def error_left(coarse, fine, factor, order):
    return (coarse - fine) / factor ** (order - 1)
