"""The side of a triangle is a difference of lengths."""


def carriages(x, y, length):
    if abs(y) > length:
        return None
    aside = length - abs(y)
    return x - aside, x + aside
