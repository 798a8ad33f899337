"""Each sample gets the time after its step."""

_whole = integrate


def integrate(step, accel, q0, v0, t_end, h):
    t, q, v = _whole(step, accel, q0, v0, t_end, h)
    return t + h, q, v
