"""With hypot."""


def total_error(errors):
    return math.hypot(*errors)
