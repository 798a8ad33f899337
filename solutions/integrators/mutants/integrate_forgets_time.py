"""Every step is told that it starts at time 0."""

_whole = integrate


def integrate(step, accel, q0, v0, t_end, h):
    return _whole(lambda accel, _t, q, v, h: step(accel, 0.0, q, v, h), accel, q0, v0, t_end, h)
