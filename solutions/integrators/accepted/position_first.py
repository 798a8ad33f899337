"""Semi-implicit Euler the other way round: drift, then kick with the acceleration at the new position."""


def semi_implicit_euler_step(accel, t, q, v, h):
    q_next = q + h * v
    return q_next, v + h * accel(t + h, q_next, v)
