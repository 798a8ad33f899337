"""Two ways to one point: the model solution."""

import math


def carriages(x, y, length):
    """Where a carriage on the line y = 0 can stand so that the tip of its rod is at a point."""
    if abs(y) > length:
        return None
    aside = math.sqrt(length**2 - y**2)
    return x - aside, x + aside
