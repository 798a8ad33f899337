"""Takes the largest."""


def total_error(errors):
    return max(errors)
