"""Time is a running sum over the right number of steps, and it stays within 1e-9."""


def integrate(step, accel, q0, v0, t_end, h):
    n = round(t_end / h)
    if abs(t_end / h - n) > 1e-6:
        raise ValueError(f"{t_end} is not a multiple of {h}")
    t, q, v = 0.0, np.array(q0, dtype=float), np.array(v0, dtype=float)
    rows = [(t, q, v)]
    for _ in range(n):
        q, v = step(accel, t, q, v, h)
        t += h
        rows.append((t, q, v))
    return tuple(np.array(column) for column in zip(*rows))
