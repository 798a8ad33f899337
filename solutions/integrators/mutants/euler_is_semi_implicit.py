"""The chapter's own slip: what is called Euler updates the velocity first and moves with the new one."""


def explicit_euler_step(accel, t, q, v, h):
    v = v + h * accel(t, q, v)
    q = q + h * v
    return q, v
