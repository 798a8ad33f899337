"""The wrong sign."""


def growth(k, m, h):
    return 1.0 - h * h * k / m
