"""Half a kick to begin with, then a whole one."""


def velocity_verlet_step(accel, t, q, v, h):
    v_half = v + 0.5 * h * np.asarray(accel(t, q, v))
    q_new = q + h * v_half
    v_new = v_half + h * np.asarray(accel(t + h, q_new, v_half))
    return q_new, v_new
