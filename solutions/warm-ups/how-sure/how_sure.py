"""How sure is a mean?: the model solution."""

import math
import statistics


def standard_error(values):
    """Standard error of the mean."""
    return statistics.stdev(values) / math.sqrt(len(values))
