"""How long does it fall?: the model solution."""

import math


def fall_time(height, g=9.81):
    """Time of a fall from rest, without air."""
    return math.sqrt(2.0 * height / g)
