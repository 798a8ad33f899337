"""Cuts off after adding a half."""


def steps_in(duration, h):
    return int(duration / h + 0.5)
