"""The ends are converted to the type of y, so when y holds whole numbers the ends are truncated to whole
numbers before the comparison.
"""

import numpy as np


def coverage(y, lo, hi):
    y = np.asarray(y)
    bounds = np.empty((2, y.size), dtype=y.dtype)
    bounds[0] = lo
    bounds[1] = hi
    inside = (y >= bounds[0]) & (y <= bounds[1])
    return float(inside.sum() / y.size)
