"""The rod lies along the rail."""


def carriages(x, y, length):
    if abs(y) > length:
        return None
    return x - length, x + length
