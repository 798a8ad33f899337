"""The middle slopes are taken a whole step ahead."""


def rk4_step(accel, t, q, v, h):
    def slope(t, q, v):
        return np.array([v, accel(t, q, v)])

    y = np.array([q, v])
    k1 = slope(t, *y)
    k2 = slope(t + h / 2, *(y + h * k1))
    k3 = slope(t + h / 2, *(y + h * k2))
    k4 = slope(t + h, *(y + h * k3))
    return tuple(y + h * (k1 + 2 * k2 + 2 * k3 + k4) / 6)
