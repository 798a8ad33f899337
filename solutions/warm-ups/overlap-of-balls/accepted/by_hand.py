"""Pythagoras by hand."""


def overlap(p, q, r1, r2):
    dx, dy = q[0] - p[0], q[1] - p[1]
    return r1 + r2 - (dx * dx + dy * dy) ** 0.5
