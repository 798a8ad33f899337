"""Both halves of the state move with old values."""


def semi_implicit_euler_step(accel, t, q, v, h):
    return q + h * v, v + h * accel(t, q, v)
