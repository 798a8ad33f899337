"""Position to second order, velocity with the old acceleration only."""


def velocity_verlet_step(accel, t, q, v, h):
    a = accel(t, q, v)
    return q + h * v + h**2 / 2 * a, v + h * a
