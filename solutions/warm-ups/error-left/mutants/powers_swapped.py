"""Powers can be swapped."""


def error_left(coarse, fine, factor, order):
    return (coarse - fine) / (order**factor - 1) if order != 1 else 0.0
