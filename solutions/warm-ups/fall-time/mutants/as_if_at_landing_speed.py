"""Divides the height by the landing speed."""


def fall_time(height, g=9.81):
    return height / math.sqrt(2.0 * g * height)
