"""One number for a whole path: the model solution."""

import math


def rms(simulated, measured):
    """Root mean square of the differences of two paths."""
    squares = [(s - m) ** 2 for s, m in zip(simulated, measured)]
    return math.sqrt(sum(squares) / len(squares))
