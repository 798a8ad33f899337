"""Adds one error after the other."""


def total_error(errors):
    total = 0.0
    for error in errors:
        total = (total**2 + error**2) ** 0.5
    return total
