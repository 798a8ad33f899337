"""Divides by the number."""


def total_error(errors):
    return math.sqrt(sum(error * error for error in errors) / len(errors))
