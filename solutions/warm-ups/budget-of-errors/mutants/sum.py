"""Adds them."""


def total_error(errors):
    return sum(errors)
