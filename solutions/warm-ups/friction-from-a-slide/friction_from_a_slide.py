"""Friction from a tape measure: the model solution."""


def friction_coefficient(v, distance, g=9.81):
    """Coefficient of friction of a block that slides to rest."""
    return v * v / (2.0 * g * distance)
