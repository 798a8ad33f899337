"""There is no simulation without a step."""


def integrate(step, accel, q0, v0, t_end, h):
    n = max(1, round(t_end / h))
    if abs(t_end / h - round(t_end / h)) > 1e-6:
        raise ValueError
    t = h * np.arange(n + 1)
    q = np.empty((n + 1, len(q0)))
    v = np.empty((n + 1, len(v0)))
    q[0], v[0] = q0, v0
    for i in range(n):
        q[i + 1], v[i + 1] = step(accel, t[i], q[i], v[i], h)
    return t, q, v
