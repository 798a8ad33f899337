"""First finds the exact result."""


def error_left(coarse, fine, factor, order):
    power = factor**order
    exact = (power * fine - coarse) / (power - 1)
    return fine - exact
