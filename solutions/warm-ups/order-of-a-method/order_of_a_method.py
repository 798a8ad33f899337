"""Halve the step, read the order: the model solution."""

import math


def observed_order(h, error, h_small, error_small):
    """Power of the step with which the error goes, from two runs."""
    return math.log(error / error_small) / math.log(h / h_small)
