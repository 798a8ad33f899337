"""At rest the caller's own position is returned."""


def explicit_euler_step(accel, t, q, v, h):
    a = accel(t, q, v)
    return (q + h * v if np.any(v) else q), v + h * a
