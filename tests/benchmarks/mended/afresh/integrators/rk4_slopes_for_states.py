"""The next slope is taken at the last slope, not at a state."""


def rk4_step(accel, t, q, v, h):
    def f(t, q, v):
        return v, accel(t, q, v)

    a = f(t, q, v)
    b = f(t + h / 2, *a)
    c = f(t + h / 2, *b)
    d = f(t + h, *c)
    return q + h / 6 * (a[0] + 2 * b[0] + 2 * c[0] + d[0]), v + h / 6 * (a[1] + 2 * b[1] + 2 * c[1] + d[1])
