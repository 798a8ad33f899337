"""How many steps are in a second?"""


def steps_in(duration, h):
    """Number of steps in a duration.

    Args:
        duration: s, a whole number of steps up to rounding.
        h: length of a step, s.

    Returns:
        int.
    """
    return int(duration / h)
