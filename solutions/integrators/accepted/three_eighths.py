"""Kutta's other method of 1901, the 3/8 rule: stages at 0, 1/3, 2/3 and 1."""


def rk4_step(accel, t, q, v, h):
    def f(t, q, v):
        return v, accel(t, q, v)

    a1, b1 = f(t, q, v)
    a2, b2 = f(t + h / 3, q + h / 3 * a1, v + h / 3 * b1)
    a3, b3 = f(t + 2 * h / 3, q + h * (a2 - a1 / 3), v + h * (b2 - b1 / 3))
    a4, b4 = f(t + h, q + h * (a1 - a2 + a3), v + h * (b1 - b2 + b3))
    return q + h / 8 * (a1 + 3 * a2 + 3 * a3 + a4), v + h / 8 * (b1 + 3 * b2 + 3 * b3 + b4)
