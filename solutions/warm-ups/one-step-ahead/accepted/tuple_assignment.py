"""Assigns both at once."""


def step_ahead(x, v, a, h):
    x, v = x + v * h, v + a * h
    return x, v
