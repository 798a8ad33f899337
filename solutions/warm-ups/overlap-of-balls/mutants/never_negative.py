"""Cuts gaps off at zero."""


def overlap(p, q, r1, r2):
    return max(0.0, r1 + r2 - math.dist(p, q))
