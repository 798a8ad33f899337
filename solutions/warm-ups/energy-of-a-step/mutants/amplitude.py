"""Gives the growth of the swing's width."""


def growth(k, m, h):
    return (1.0 + h * h * k / m) ** 0.5
