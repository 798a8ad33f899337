"""The velocity is updated with the acceleration at the new position only."""


def velocity_verlet_step(accel, t, q, v, h):
    q_next = q + h * v + h**2 / 2 * accel(t, q, v)
    return q_next, v + h * accel(t + h, q_next, v)
