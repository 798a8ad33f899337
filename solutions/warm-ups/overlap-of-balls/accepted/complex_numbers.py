"""Centres as complex numbers."""


def overlap(p, q, r1, r2):
    return r1 + r2 - abs(complex(*p) - complex(*q))
