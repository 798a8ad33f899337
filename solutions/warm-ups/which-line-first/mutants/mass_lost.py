"""Mends the loop, and loses the mass on the way."""


def swing(x, v, k, m, h, n):
    for _ in range(n):
        v -= h * k * x
        x += h * v
    return x, v
