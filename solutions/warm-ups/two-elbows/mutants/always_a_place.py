"""Every point can be reached."""


def carriages(x, y, length):
    aside = math.sqrt(abs(length**2 - y**2))
    return x - aside, x + aside
