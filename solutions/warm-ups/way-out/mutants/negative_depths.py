"""An overlap is negative."""


def way_out(x, y, width, height):
    along, across = abs(x) - width, abs(y) - height
    if along > 0 or across > 0:
        return 0.0, 0.0
    if along < across:
        return (along if x > 0 else -along), 0.0
    return 0.0, (across if y > 0 else -across)
