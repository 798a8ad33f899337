# The fourth stage looks ahead by half a step.


def rk4_step(accel, t, q, v, h):
    k1q, k1v = v, accel(t, q, v)
    k2q, k2v = v + h / 2 * k1v, accel(t + h / 2, q + h / 2 * k1q, v + h / 2 * k1v)
    k3q, k3v = v + h / 2 * k2v, accel(t + h / 2, q + h / 2 * k2q, v + h / 2 * k2v)
    k4q, k4v = v + h / 2 * k3v, accel(t + h / 2, q + h / 2 * k3q, v + h / 2 * k3v)
    return q + h / 6 * (k1q + 2 * k2q + 2 * k3q + k4q), v + h / 6 * (k1v + 2 * k2v + 2 * k3v + k4v)
