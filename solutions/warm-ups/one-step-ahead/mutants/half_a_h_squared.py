"""Adds a h^2 / 2 to the position."""


def step_ahead(x, v, a, h):
    return x + h * v + a * h * h / 2, v + h * a
