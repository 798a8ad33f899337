"""The rail is vertical."""


def carriages(x, y, length):
    if abs(x) > length:
        return None
    aside = math.sqrt(length**2 - x**2)
    return y - aside, y + aside
