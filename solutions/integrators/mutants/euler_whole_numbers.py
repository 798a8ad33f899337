"""Results go into arrays of q's type, which may be integers."""


def explicit_euler_step(accel, t, q, v, h):
    q_next, v_next = np.empty_like(q), np.empty_like(v)
    q_next[:] = q + h * v
    v_next[:] = v + h * accel(t, q, v)
    return q_next, v_next
