"""By way of the time of the slide."""


def friction_coefficient(v, distance, g=9.81):
    time = 2 * distance / v
    return v / (g * time)
