"""The sign does not matter."""


def error_left(coarse, fine, factor, order):
    return (fine - coarse) / (factor**order - 1)
