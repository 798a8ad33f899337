"""A miss is reported as -1."""

_right_moment = time_of_impact


def time_of_impact(xa, va, ra, xb, vb, rb, dt):
    t = _right_moment(xa, va, ra, xb, vb, rb, dt)
    return -1.0 if t is None else t
