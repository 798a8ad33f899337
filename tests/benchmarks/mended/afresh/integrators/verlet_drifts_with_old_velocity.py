"""The drift takes v, not the half-kicked velocity."""


def velocity_verlet_step(accel, t, q, v, h):
    w = v + h / 2 * np.asarray(accel(t, q, v))
    q_next = q + h * v
    v_next = w + h / 2 * np.asarray(accel(t + h, q_next, w))
    return q_next, v_next
