"""Boxes in a list overlap."""


def way_out(x, y, width, height):
    along, across = width - abs(x), height - abs(y)
    if along < across:
        return (along if x > 0 else -along), 0.0
    return 0.0, (across if y > 0 else -across)
