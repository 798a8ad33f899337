"""Takes the drop as g t^2."""


def fall_time(height, g=9.81):
    return math.sqrt(height / g)
