"""By way of the angular frequency."""


def growth(k, m, h):
    omega = (k / m) ** 0.5
    return 1.0 + (h * omega) ** 2
