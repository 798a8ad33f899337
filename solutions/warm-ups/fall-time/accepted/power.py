"""A power instead of a root."""


def fall_time(height, g=9.81):
    return (2.0 * height / g) ** 0.5
