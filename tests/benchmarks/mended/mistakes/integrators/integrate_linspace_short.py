# The times are n + 1 points whose last is one step early.


def integrate(step, accel, q0, v0, t_end, h):
    n = round(t_end / h)
    if abs(t_end / h - n) > 1e-6:
        raise ValueError("t_end is not a whole number of steps")
    t = np.linspace(0.0, t_end, n + 1, endpoint=False)
    q = np.zeros((n + 1, len(q0)))
    v = np.zeros((n + 1, len(v0)))
    q[0], v[0] = q0, v0
    for i in range(n):
        q[i + 1], v[i + 1] = step(accel, t[i], q[i], v[i], h)
    return t, q, v
