"""The four slopes are averaged with equal weights."""


def rk4_step(accel, t, q, v, h):
    def slope(t, q, v):
        return np.array([v, accel(t, q, v)])

    y = np.array([q, v])
    k1 = slope(t, *y)
    k2 = slope(t + h / 2, *(y + h / 2 * k1))
    k3 = slope(t + h / 2, *(y + h / 2 * k2))
    k4 = slope(t + h, *(y + h * k3))
    return tuple(y + h * (k1 + k2 + k3 + k4) / 4)
