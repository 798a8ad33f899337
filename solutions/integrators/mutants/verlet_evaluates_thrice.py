"""The right values, with the old acceleration evaluated once for the position and once for the velocity."""


def velocity_verlet_step(accel, t, q, v, h):
    q_next = q + h * v + h**2 / 2 * accel(t, q, v)
    return q_next, v + h / 2 * (accel(t, q, v) + accel(t + h, q_next, v))
