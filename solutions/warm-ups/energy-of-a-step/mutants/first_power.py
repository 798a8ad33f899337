"""Takes h once."""


def growth(k, m, h):
    return 1.0 + h * (k / m) ** 0.5
