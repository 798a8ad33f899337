"""The position is wrapped to -pi..pi as if it were always an angle."""


def explicit_euler_step(accel, t, q, v, h):
    a = np.asarray(accel(t, q, v))
    q_next = (q + h * v + np.pi) % (2 * np.pi) - np.pi
    v_next = v + h * a
    return q_next, v_next
