"""The greater depth counts."""


def way_out(x, y, width, height):
    along, across = width - abs(x), height - abs(y)
    if along <= 0 or across <= 0:
        return 0.0, 0.0
    if along > across:
        return math.copysign(along, x), 0.0
    return 0.0, math.copysign(across, y)
