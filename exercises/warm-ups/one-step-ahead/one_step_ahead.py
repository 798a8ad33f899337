"""One step ahead."""


def step_ahead(x, v, a, h):
    """Position and velocity one step later, with constant rates.

    Args:
        x: position, m.
        v: velocity, m/s.
        a: acceleration, m/s^2.
        h: length of the step, s.

    Returns:
        Pair of the new position and the new velocity.
    """
    raise NotImplementedError
