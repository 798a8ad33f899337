"""A budget of errors."""


def total_error(errors):
    """Size of several independent errors together.

    Args:
        errors: sizes, in one unit.

    Returns:
        float, in that unit.
    """
    raise NotImplementedError
