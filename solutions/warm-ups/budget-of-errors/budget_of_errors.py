"""A budget of errors: the model solution."""

import math


def total_error(errors):
    """Size of several independent errors together."""
    return math.sqrt(sum(error * error for error in errors))
