"""The position is brought back to -pi to pi, as if it were always an angle."""

_right = explicit_euler_step


def explicit_euler_step(accel, t, q, v, h):
    q_next, v_next = _right(accel, t, q, v, h)
    return (q_next + np.pi) % (2 * np.pi) - np.pi, v_next
