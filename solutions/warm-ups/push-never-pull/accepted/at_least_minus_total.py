"""The correction is at least minus the sum."""


def applied(total, wanted):
    return max(wanted, -total)
