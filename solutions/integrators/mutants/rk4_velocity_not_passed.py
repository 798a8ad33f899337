"""accel gets each stage's position with the velocity of the start; only damping reveals it."""

_right_rk4 = rk4_step


def rk4_step(accel, t, q, v, h):
    return _right_rk4(lambda t, q, _v: accel(t, q, v), t, q, v, h)
