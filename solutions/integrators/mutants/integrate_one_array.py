"""Both histories are one array under two names."""


def integrate(step, accel, q0, v0, t_end, h):
    n = round(t_end / h)
    if abs(t_end / h - n) > 1e-6:
        raise ValueError("not a whole number of steps")
    q = v = np.zeros((n + 1, len(q0)))
    q[0], v[0] = q0, v0
    for i in range(n):
        q[i + 1], v[i + 1] = step(accel, i * h, q[i], v[i], h)
    return h * np.arange(n + 1), q, v
