"""Gives the deceleration."""


def friction_coefficient(v, distance, g=9.81):
    return v * v / (2.0 * distance)
