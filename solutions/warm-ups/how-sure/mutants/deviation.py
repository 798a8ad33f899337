"""Gives the deviation of one value."""


def standard_error(values):
    return statistics.stdev(values)
