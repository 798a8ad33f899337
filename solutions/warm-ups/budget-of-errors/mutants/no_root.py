"""Forgets the root."""


def total_error(errors):
    return sum(error * error for error in errors)
