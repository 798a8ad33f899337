"""The square term lacks its factor one half."""


def velocity_verlet_step(accel, t, q, v, h):
    a = accel(t, q, v)
    q_next = q + h * v + h**2 * a
    return q_next, v + h / 2 * (a + accel(t + h, q_next, v))
