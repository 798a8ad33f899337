"""Adds one to what was cut off."""


def steps_in(duration, h):
    return int(duration / h) + 1
