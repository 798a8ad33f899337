"""=+ for +=: after the first step the time is always h."""


def integrate(step, accel, q0, v0, t_end, h):
    n = round(t_end / h)
    if abs(t_end / h - n) > 1e-6:
        raise ValueError
    t = h * np.arange(n + 1)
    q = np.empty((n + 1, len(q0)))
    v = np.empty((n + 1, len(v0)))
    q[0], v[0] = q0, v0
    now = 0.0
    for i in range(n):
        q[i + 1], v[i + 1] = step(accel, now, q[i], v[i], h)
        now = +h
    return t, q, v
