"""Cuts off every negative correction."""


def applied(total, wanted):
    return max(wanted, 0.0)
