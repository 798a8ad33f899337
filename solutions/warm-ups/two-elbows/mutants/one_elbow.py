"""Inverse kinematics has one answer."""


def carriages(x, y, length):
    if abs(y) > length:
        return None
    aside = math.sqrt(length**2 - y**2)
    return x - aside, x - aside
