"""A step is what changes: it returns h v and h a, and the caller adds them."""


def explicit_euler_step(accel, t, q, v, h):
    dq = h * np.asarray(v, dtype=float)
    dv = h * np.asarray(accel(t, q, v), dtype=float)
    return dq, dv
