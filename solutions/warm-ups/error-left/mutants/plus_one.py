"""The two errors add up."""


def error_left(coarse, fine, factor, order):
    return (coarse - fine) / (factor**order + 1)
