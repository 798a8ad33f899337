"""The order of a pair is free."""


def way_out(x, y, width, height):
    along, across = width - abs(x), height - abs(y)
    if along <= 0 or across <= 0:
        return 0.0, 0.0
    if along < across:
        return 0.0, math.copysign(along, x)
    return math.copysign(across, y), 0.0
