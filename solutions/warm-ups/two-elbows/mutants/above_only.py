"""Points lie above the rail."""


def carriages(x, y, length):
    if y > length:
        return None
    aside = math.sqrt(abs(length**2 - y**2))
    return x - aside, x + aside
