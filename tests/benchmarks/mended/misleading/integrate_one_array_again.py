"""integrate appends the same array each time."""


def integrate(step, accel, q0, v0, t_end, h):
    n = round(t_end / h)
    if abs(t_end / h - n) > 1e-6:
        raise ValueError("not a whole number of steps")
    q, v = np.array(q0, dtype=float), np.array(v0, dtype=float)
    qs, vs = [q], [v]
    for i in range(n):
        q[:], v[:] = step(accel, i * h, q, v, h)
        qs.append(q)
        vs.append(v)
    return h * np.arange(n + 1), np.array(qs), np.array(vs)
