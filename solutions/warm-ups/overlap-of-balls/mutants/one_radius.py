"""Counts one radius only."""


def overlap(p, q, r1, r2):
    return max(r1, r2) - math.dist(p, q)
