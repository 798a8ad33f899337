"""A difference of squares is a length."""


def carriages(x, y, length):
    if abs(y) > length:
        return None
    aside = length**2 - y**2
    return x - aside, x + aside
