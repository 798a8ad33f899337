"""A duration of zero is refused."""


def integrate(step, accel, q0, v0, t_end, h):
    N = round(t_end / h)
    if t_end <= 0:
        raise ValueError("t_end must be positive")
    if abs(t_end / h - N) > 1e-6:
        raise ValueError("t_end is not a whole number of steps")
    q0 = np.array(q0, dtype=float)
    v0 = np.array(v0, dtype=float)
    t = np.arange(N + 1) * h
    q = np.zeros((N + 1, len(q0)))
    v = np.zeros((N + 1, len(v0)))
    q[0] = q0
    v[0] = v0
    for i in range(N):
        q[i + 1], v[i + 1] = step(accel, i * h, q[i], v[i], h)
    return t, q, v
