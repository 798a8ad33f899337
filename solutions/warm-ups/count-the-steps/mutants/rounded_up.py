"""Rounds up."""


def steps_in(duration, h):
    import math

    return math.ceil(duration / h)
