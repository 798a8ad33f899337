"""Gill's method of 1951: four stages with square roots of two, made for machines short of memory."""

_R = 2**0.5


def rk4_step(accel, t, q, v, h):
    y = np.concatenate([q, v])
    d = len(q)

    def f(t, y):
        return np.concatenate([y[d:], accel(t, y[:d], y[d:])])

    k1 = h * f(t, y)
    k2 = h * f(t + h / 2, y + k1 / 2)
    k3 = h * f(t + h / 2, y + (_R - 1) / 2 * k1 + (2 - _R) / 2 * k2)
    k4 = h * f(t + h, y - _R / 2 * k2 + (1 + _R / 2) * k3)
    y = y + (k1 + (2 - _R) * k2 + (2 + _R) * k3 + k4) / 6
    return y[:d].copy(), y[d:].copy()
