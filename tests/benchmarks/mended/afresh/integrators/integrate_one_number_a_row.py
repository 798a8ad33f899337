"""A row has room for one number, however many coordinates there are."""


def integrate(step, accel, q0, v0, t_end, h):
    n = round(t_end / h)
    if abs(t_end / h - n) > 1e-6:
        raise ValueError
    t = h * np.arange(n + 1)
    q = np.zeros(n + 1)
    v = np.zeros(n + 1)
    q[0], v[0] = q0, v0
    for i in range(n):
        q[i + 1], v[i + 1] = step(accel, t[i], q[i], v[i], h)
    return t, q, v
