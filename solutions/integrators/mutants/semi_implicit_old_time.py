"""Position first, but the acceleration at the new position is evaluated at the old time."""


def semi_implicit_euler_step(accel, t, q, v, h):
    q_next = q + h * v
    return q_next, v + h * accel(t, q_next, v)
