"""Solves for both new values."""


def swing(x, v, k, m, h, n):
    w = h * h * k / m
    for _ in range(n):
        v = (v - h * k / m * x) / (1 + w)
        x = x + h * v
    return x, v
