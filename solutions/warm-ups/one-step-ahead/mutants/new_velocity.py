"""Moves with the velocity it has just computed."""


def step_ahead(x, v, a, h):
    v = v + h * a
    return x + h * v, v
