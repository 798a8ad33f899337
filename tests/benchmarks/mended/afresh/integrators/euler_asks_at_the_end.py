"""The step goes to t + h, so that is the time at which the force is asked for."""


def explicit_euler_step(accel, t, q, v, h):
    t_next = t + h
    acceleration = np.asarray(accel(t_next, q, v))
    return q + h * v, v + h * acceleration
