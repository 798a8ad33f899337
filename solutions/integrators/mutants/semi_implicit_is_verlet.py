"""Velocity Verlet in place of semi-implicit Euler."""


def semi_implicit_euler_step(accel, t, q, v, h):
    return velocity_verlet_step(accel, t, q, v, h)
