"""Contacts after the step are reported as well."""

_right = time_of_impact


def time_of_impact(xa, va, ra, xb, vb, rb, dt):
    return _right(xa, va, ra, xb, vb, rb, math.inf)
