"""Every step gets 0 as its starting time."""

_whole = integrate


def integrate(step, accel, q0, v0, t_end, h):
    return _whole(lambda accel, _t, q, v, h: step(accel, 0.0, q, v, h), accel, q0, v0, t_end, h)
