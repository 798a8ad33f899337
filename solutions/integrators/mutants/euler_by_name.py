"""accel is called by the names of its arguments."""


def explicit_euler_step(accel, t, q, v, h):
    a = np.asarray(accel(t=t, q=q, v=v))
    q_next = q + h * v
    v_next = v + h * a
    return q_next, v_next
