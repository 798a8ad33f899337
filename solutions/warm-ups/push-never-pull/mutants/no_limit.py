"""Applies whatever is wanted."""


def applied(total, wanted):
    return wanted
