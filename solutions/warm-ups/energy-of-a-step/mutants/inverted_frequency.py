"""Divides the mass by the stiffness."""


def growth(k, m, h):
    return 1.0 + h * h * m / k
