"""How deep are they in each other?: the model solution."""

import math


def overlap(p, q, r1, r2):
    """How deep two balls are in each other."""
    return r1 + r2 - math.dist(p, q)
