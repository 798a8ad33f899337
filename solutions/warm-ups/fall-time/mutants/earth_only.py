"""Writes 9.81 and forgets g."""


def fall_time(height, g=9.81):
    return math.sqrt(2.0 * height / 9.81)
