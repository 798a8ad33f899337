"""Velocity and position come back in the wrong order."""


def semi_implicit_euler_step(accel, t, q, v, h):
    v_next = v + h * accel(t, q, v)
    return v_next, q + h * v_next
