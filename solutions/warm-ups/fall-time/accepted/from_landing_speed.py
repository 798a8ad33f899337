"""The landing speed first, from the energy."""


def fall_time(height, g=9.81):
    speed = math.sqrt(2.0 * g * height)
    return speed / g
