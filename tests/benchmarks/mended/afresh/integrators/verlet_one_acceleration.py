"""The second acceleration is computed and not used; the square term is a sixth."""


def velocity_verlet_step(accel, t, q, v, h):
    a = accel(t, q, v)
    q1 = q + h * v + h * h * a / 6
    b = accel(t + h, q1, v)
    return q1, v + h * a
