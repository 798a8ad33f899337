"""Solves (x - s)^2 + y^2 = length^2."""


def carriages(x, y, length):
    import numpy as np

    under = length * length - y * y
    if under < 0:
        return None
    return np.array([x - under**0.5, x + under**0.5])
