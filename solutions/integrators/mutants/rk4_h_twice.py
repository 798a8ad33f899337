"""The slopes are multiplied by h when they are taken and again when they are used."""


def rk4_step(accel, t, q, v, h):
    k1q, k1v = h * v, h * accel(t, q, v)
    k2q, k2v = h * (v + h / 2 * k1v), h * accel(t + h / 2, q + h / 2 * k1q, v + h / 2 * k1v)
    k3q, k3v = h * (v + h / 2 * k2v), h * accel(t + h / 2, q + h / 2 * k2q, v + h / 2 * k2v)
    k4q, k4v = h * (v + h * k3v), h * accel(t + h, q + h * k3q, v + h * k3v)
    return q + h / 6 * (k1q + 2 * k2q + 2 * k3q + k4q), v + h / 6 * (k1v + 2 * k2v + 2 * k3v + k4v)
