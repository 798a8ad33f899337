"""A force does not depend on the time."""


def explicit_euler_step(accel, t, q, v, h):
    a = np.asarray(accel(0.0, q, v))
    q_next = q + h * v
    v_next = v + h * a
    return q_next, v_next
