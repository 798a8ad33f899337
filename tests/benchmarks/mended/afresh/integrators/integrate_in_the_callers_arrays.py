"""The caller's float arrays q0 and v0 are used as the running state and overwritten."""


def integrate(step, accel, q0, v0, t_end, h):
    n = round(t_end / h)
    if abs(t_end / h - n) > 1e-6:
        raise ValueError("not a whole number of steps")
    q, v = np.asarray(q0, dtype=float), np.asarray(v0, dtype=float)
    qs, vs = [q.copy()], [v.copy()]
    for i in range(n):
        q[:], v[:] = step(accel, i * h, q, v, h)
        qs.append(q.copy())
        vs.append(v.copy())
    return np.arange(n + 1) * h, np.array(qs), np.array(vs)
