"""The number of steps is truncated, and the initial state is not among the samples."""


def integrate(step, accel, q0, v0, t_end, h):
    if abs(t_end / h - round(t_end / h)) > 1e-6:
        raise ValueError("not a whole number of steps")
    n = int(t_end / h)
    q, v = np.array(q0, dtype=float), np.array(v0, dtype=float)
    rows = []
    for i in range(n):
        q, v = step(accel, i * h, q, v, h)
        rows.append((q, v))
    t = h * np.arange(n)
    return t, np.array([q for q, _ in rows]), np.array([v for _, v in rows])
