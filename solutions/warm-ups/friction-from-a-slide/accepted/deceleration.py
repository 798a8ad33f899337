"""By way of the deceleration."""


def friction_coefficient(v, distance, g=9.81):
    deceleration = v**2 / distance / 2
    return deceleration / g
