"""Too fast to be seen."""


def fastest(thickness, radius, h):
    """Largest speed at which an engine is sure to find a ball inside a wall.

    Args:
        thickness: of the wall, m.
        radius: of the ball, m.
        h: time between two looks, s.

    Returns:
        float, m/s.
    """
    raise NotImplementedError
