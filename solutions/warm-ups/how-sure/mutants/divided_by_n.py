"""Divides by the number."""


def standard_error(values):
    return statistics.stdev(values) / len(values)
