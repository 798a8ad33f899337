"""The arrays take the type of the initial state."""


def integrate(step, accel, q0, v0, t_end, h):
    n = round(t_end / h)
    if abs(t_end / h - n) > 1e-6:
        raise ValueError
    q, v = np.array([q0] * (n + 1)), np.array([v0] * (n + 1))
    for i in range(n):
        q[i + 1], v[i + 1] = step(accel, i * h, q[i], v[i], h)
    return h * np.arange(n + 1), q, v
