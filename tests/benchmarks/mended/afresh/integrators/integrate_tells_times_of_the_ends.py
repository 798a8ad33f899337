"""Step number i is told (i + 1) h: it works on the sample i + 1."""


def integrate(step, accel, q0, v0, t_end, h):
    n = round(t_end / h)
    if abs(t_end / h - n) > 1e-6:
        raise ValueError("t_end is not a whole number of steps")
    t = h * np.arange(n + 1)
    q = np.zeros((n + 1, len(q0)))
    v = np.zeros((n + 1, len(q0)))
    q[0], v[0] = q0, v0
    for i in range(1, n + 1):
        q[i], v[i] = step(accel, t[i], q[i - 1], v[i - 1], h)
    return t, q, v
