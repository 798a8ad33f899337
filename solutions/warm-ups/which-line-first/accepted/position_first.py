"""Moves first, and takes the force at the new position."""


def swing(x, v, k, m, h, n):
    for _ in range(n):
        x += h * v
        v += h * (-k / m * x)
    return x, v
