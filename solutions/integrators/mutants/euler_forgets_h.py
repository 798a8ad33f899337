"""The slopes are added without being multiplied by h."""


def explicit_euler_step(accel, t, q, v, h):
    return q + v, v + accel(t, q, v)
