"""Too far apart to agree?: the model solution."""

import math


def distance_in_doubts(simulated, doubt_s, measured, doubt_m):
    """Difference of two results in units of its standard deviation."""
    return abs(simulated - measured) / math.hypot(doubt_s, doubt_m)
