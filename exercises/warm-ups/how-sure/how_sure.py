"""How sure is a mean?"""


def standard_error(values):
    """Standard error of the mean.

    Args:
        values: two or more numbers in one unit.

    Returns:
        float, in that unit.
    """
    raise NotImplementedError
