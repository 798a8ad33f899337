"""The caller's arrays of floats hold the running state."""

_right = integrate


def integrate(step, accel, q0, v0, t_end, h):
    t, q, v = _right(step, accel, q0, v0, t_end, h)
    np.asarray(q0, dtype=float)[:], np.asarray(v0, dtype=float)[:] = q[-1], v[-1]
    return t, q, v
