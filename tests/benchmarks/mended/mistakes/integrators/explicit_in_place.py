# The arguments are changed.


def explicit_euler_step(accel, t, q, v, h):
    a = accel(t, q, v)
    q += h * v
    v += h * a
    return q, v
