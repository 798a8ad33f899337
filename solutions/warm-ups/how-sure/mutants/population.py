"""Estimates with n."""


def standard_error(values):
    return statistics.pstdev(values) / math.sqrt(len(values))
