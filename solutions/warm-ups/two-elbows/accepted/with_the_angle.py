"""Takes the angle of the rod."""


def carriages(x, y, length):
    if not -length <= y <= length:
        return None
    angle = math.asin(y / length)
    return [x - length * math.cos(angle), x + length * math.cos(angle)]
