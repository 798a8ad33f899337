"""Adds up a list of pairs."""


def step_ahead(x, v, a, h):
    return [now + h * rate for now, rate in ((x, v), (v, a))]
