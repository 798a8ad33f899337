"""Spends its time inside one C call that no signal interrupts."""

import itertools


def scale(values, factor):
    return sum(itertools.repeat(1, 10**10))
