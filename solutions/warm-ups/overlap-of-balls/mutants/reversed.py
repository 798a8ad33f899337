"""Gives the gap."""


def overlap(p, q, r1, r2):
    return math.dist(p, q) - r1 - r2
