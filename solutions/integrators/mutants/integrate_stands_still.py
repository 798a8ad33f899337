"""What the step returns is thrown away."""


def integrate(step, accel, q0, v0, t_end, h):
    n = round(t_end / h)
    if abs(t_end / h - n) > 1e-6:
        raise ValueError
    t = h * np.arange(n + 1)
    q = np.empty((n + 1, len(q0)))
    v = np.empty((n + 1, len(v0)))
    q[0], v[0] = q0, v0
    for i in range(n):
        step(accel, t[i], q[i], v[i], h)
        q[i + 1], v[i + 1] = q[i], v[i]
    return t, q, v
