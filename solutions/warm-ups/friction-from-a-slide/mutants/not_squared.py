"""Forgets the square."""


def friction_coefficient(v, distance, g=9.81):
    return v / (2.0 * g * distance)
