"""A last step that is begun must be counted: ceil."""


def integrate(step, accel, q0, v0, t_end, h):
    n = math.ceil(t_end / h)
    if abs(t_end / h - round(t_end / h)) > 1e-6:
        raise ValueError("no whole number of steps")
    ts, qs, vs = [0.0], [np.array(q0, dtype=float)], [np.array(v0, dtype=float)]
    for i in range(n):
        q, v = step(accel, i * h, qs[-1], vs[-1], h)
        ts.append((i + 1) * h)
        qs.append(np.array(q))
        vs.append(np.array(v))
    return np.array(ts), np.array(qs), np.array(vs)
