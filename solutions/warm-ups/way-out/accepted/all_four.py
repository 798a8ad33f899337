"""Tries all four ways."""


def way_out(x, y, width, height):
    ways = [(width - x, (1, 0)), (width + x, (-1, 0)), (height - y, (0, 1)), (height + y, (0, -1))]
    depth, (sx, sy) = min(ways)
    return (depth * sx, depth * sy) if depth > 0 else (0, 0)
