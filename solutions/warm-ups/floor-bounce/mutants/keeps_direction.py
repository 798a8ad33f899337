"""Forgets to turn it round."""


def after_floor(v, e):
    return e * v if v < 0 else v
