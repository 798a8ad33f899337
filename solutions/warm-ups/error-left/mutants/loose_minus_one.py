"""The minus one comes last."""


def error_left(coarse, fine, factor, order):
    return (coarse - fine) / factor**order - 1
