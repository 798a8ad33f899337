"""Velocity Verlet in semi-implicit Euler's place."""


def semi_implicit_euler_step(accel, t, q, v, h):
    return velocity_verlet_step(accel, t, q, v, h)
