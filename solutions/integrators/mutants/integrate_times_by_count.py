"""The times are kept from one call to the next, by the number of steps."""

_right = integrate
_TIMES = {}


def integrate(step, accel, q0, v0, t_end, h):
    t, q, v = _right(step, accel, q0, v0, t_end, h)
    return _TIMES.setdefault(len(t), t).copy(), q, v
