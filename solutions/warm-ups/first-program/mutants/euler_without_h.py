"""Loses the step of the velocity."""


def euler_step(x, v, a, h):
    return x + h * v, v + a
