"""Takes everything back at a negative correction."""


def applied(total, wanted):
    return wanted if wanted > 0 else -total
