"""Out of reach means as near as possible."""


def carriages(x, y, length):
    aside = math.sqrt(max(length**2 - y**2, 0.0))
    return x - aside, x + aside
