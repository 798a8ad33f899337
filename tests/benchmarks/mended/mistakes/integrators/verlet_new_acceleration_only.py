# The velocity moves by the new acceleration alone.


def velocity_verlet_step(accel, t, q, v, h):
    a = accel(t, q, v)
    q_next = q + h * v + 0.5 * a * h**2
    a_next = accel(t + h, q_next, v)
    return q_next, v + h * a_next
