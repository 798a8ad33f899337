"""All four slopes are evaluated at the time of the start."""

_right_rk4 = rk4_step


def rk4_step(accel, t, q, v, h):
    return _right_rk4(lambda _t, q, v: accel(t, q, v), t, q, v, h)
