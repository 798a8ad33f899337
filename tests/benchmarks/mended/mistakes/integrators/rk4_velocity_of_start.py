# The positions of the stages move with the velocity at the start.


def rk4_step(accel, t, q, v, h):
    a1 = accel(t, q, v)
    a2 = accel(t + h / 2, q + h / 2 * v, v + h / 2 * a1)
    a3 = accel(t + h / 2, q + h / 2 * v, v + h / 2 * a2)
    a4 = accel(t + h, q + h * v, v + h * a3)
    v2, v3, v4 = v + h / 2 * a1, v + h / 2 * a2, v + h * a3
    return q + h / 6 * (v + 2 * v2 + 2 * v3 + v4), v + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4)
