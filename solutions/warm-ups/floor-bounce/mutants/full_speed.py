"""Gives all the speed back."""


def after_floor(v, e):
    return -v if v < 0 else v
