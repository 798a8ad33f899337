"""The acceleration gets position, velocity and time, in this order."""


def explicit_euler_step(accel, t, q, v, h):
    return q + h * v, v + h * accel(q, v, t)
