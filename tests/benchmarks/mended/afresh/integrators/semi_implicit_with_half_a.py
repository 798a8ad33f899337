"""A position needs its a h squared over two."""


def semi_implicit_euler_step(accel, t, q, v, h):
    a = np.asarray(accel(t, q, v))
    v_next = v + h * a
    q_next = q + h * v_next + h**2 / 2 * a
    return q_next, v_next
