"""The square term of the position has the wrong sign."""


def velocity_verlet_step(accel, t, q, v, h):
    a = accel(t, q, v)
    q_next = q + h * v - 0.5 * h * h * a
    return q_next, v + h / 2 * (a + accel(t + h, q_next, v))
