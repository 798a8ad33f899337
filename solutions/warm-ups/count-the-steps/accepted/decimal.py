"""Counts with decimal fractions."""


def steps_in(duration, h):
    from decimal import Decimal

    return int(Decimal(repr(duration)) / Decimal(repr(h)))
