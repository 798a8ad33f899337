"""Where is the hand?: the model solution."""

import math


def hand(a1, a2, l1, l2):
    """Where the end of a planar arm of two links is."""
    x = l1 * math.cos(a1) + l2 * math.cos(a1 + a2)
    y = l1 * math.sin(a1) + l2 * math.sin(a1 + a2)
    return x, y
