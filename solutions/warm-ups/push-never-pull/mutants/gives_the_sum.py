"""Gives the new sum."""


def applied(total, wanted):
    return max(total + wanted, 0.0)
