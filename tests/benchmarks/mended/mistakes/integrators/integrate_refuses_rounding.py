# A quotient that is whole but for rounding is refused.


def integrate(step, accel, q0, v0, t_end, h):
    n = round(t_end / h)
    if t_end / h != n:
        raise ValueError("t_end is not a whole number of steps")
    t = np.arange(n + 1) * h
    q = np.zeros((n + 1, len(q0)))
    v = np.zeros((n + 1, len(v0)))
    q[0], v[0] = q0, v0
    for i in range(n):
        q[i + 1], v[i + 1] = step(accel, t[i], q[i], v[i], h)
    return t, q, v
