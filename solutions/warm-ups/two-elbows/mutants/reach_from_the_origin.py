"""The rod hangs at the origin."""


def carriages(x, y, length):
    if math.hypot(x, y) > length:
        return None
    aside = math.sqrt(length**2 - y**2)
    return x - aside, x + aside
