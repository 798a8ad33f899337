"""int() truncates 28.999999999999996 to 28."""


def integrate(step, accel, q0, v0, t_end, h):
    if abs(t_end / h - round(t_end / h)) > 1e-6:
        raise ValueError
    n = int(t_end / h)
    t, q, v = h * np.arange(n + 1), np.zeros((n + 1, len(q0))), np.zeros((n + 1, len(q0)))
    q[0], v[0] = q0, v0
    for i in range(n):
        q[i + 1], v[i + 1] = step(accel, t[i], q[i], v[i], h)
    return t, q, v
