"""The rod reaches as far aside as it is high."""


def carriages(x, y, length):
    if abs(y) > length:
        return None
    return x - y, x + y
