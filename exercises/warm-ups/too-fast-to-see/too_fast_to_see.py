"""Too fast to be seen."""


def fastest(thickness, radius, h):
    """Largest speed at which a ball is sure to be seen inside a wall.

    Args:
        thickness: of the wall, m.
        radius: of the ball, m.
        h: time between two looks, s.

    Returns:
        float, m/s.
    """
    raise NotImplementedError
