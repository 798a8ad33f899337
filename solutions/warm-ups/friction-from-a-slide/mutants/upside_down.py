"""Divides the other way round."""


def friction_coefficient(v, distance, g=9.81):
    return 2.0 * g * distance / (v * v)
