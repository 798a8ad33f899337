"""Verlet in the form of mechanics textbooks: q + h v + h²/2 a, then the mean of both accelerations."""


def velocity_verlet_step(accel, t, q, v, h):
    a_old = accel(t, q, v)
    q_next = q + h * v + 0.5 * h**2 * a_old
    return q_next, v + 0.5 * h * (a_old + accel(t + h, q_next, v + h * a_old))
