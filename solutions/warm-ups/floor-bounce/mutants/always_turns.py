"""Turns every velocity round."""


def after_floor(v, e):
    return -e * v
