"""Halve the step, read the order."""


def observed_order(h, error, h_small, error_small):
    """Power of the step to which the error is proportional, from two runs.

    Args:
        h: the larger step, s.
        error: its error; positive.
        h_small: the smaller step, s.
        error_small: its error, in the same unit; positive.

    Returns:
        float.
    """
    raise NotImplementedError
