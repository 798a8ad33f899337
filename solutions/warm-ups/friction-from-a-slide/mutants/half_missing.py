"""Takes m v^2 as the energy."""


def friction_coefficient(v, distance, g=9.81):
    return v * v / (g * distance)
