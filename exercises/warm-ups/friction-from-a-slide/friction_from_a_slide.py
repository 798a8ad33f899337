"""Friction from a tape measure."""


def friction_coefficient(v, distance, g=9.81):
    """Coefficient of friction of a block that slides to rest.

    Args:
        v: speed at the start, m/s.
        distance: of the slide, m.
        g: acceleration of free fall, m/s^2.

    Returns:
        float.
    """
    raise NotImplementedError
