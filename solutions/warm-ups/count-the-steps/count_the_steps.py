"""How many steps are in a second?: the model solution."""


def steps_in(duration, h):
    """Number of steps in a duration."""
    return round(duration / h)
