"""Forgets the root of the distance."""


def overlap(p, q, r1, r2):
    return r1 + r2 - (q[0] - p[0]) ** 2 - (q[1] - p[1]) ** 2
