"""k4 starts from k2: copied from the line above and half changed."""


def rk4_step(accel, t, q, v, h):
    def f(time, y):
        return np.array([y[1], np.asarray(accel(time, y[0], y[1]))])

    y = np.array([q, v], dtype=float)
    k1 = f(t, y)
    k2 = f(t + h / 2, y + h / 2 * k1)
    k3 = f(t + h / 2, y + h / 2 * k2)
    k4 = f(t + h, y + h * k2)
    y = y + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return y[0], y[1]
