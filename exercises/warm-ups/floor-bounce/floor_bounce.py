"""Only what comes in bounces."""


def after_floor(v, e):
    """Vertical velocity after touching the floor.

    Args:
        v: before, m/s; upwards is positive.
        e: restitution, from 0 to 1.

    Returns:
        float, m/s.
    """
    raise NotImplementedError
