"""Two mistakes: rows are stored in float32, and the duration is tested with the remainder in seconds."""


def integrate(step, accel, q0, v0, t_end, h):
    quotient = t_end / h
    N = round(quotient)
    if abs(t_end - N * h) > 1e-6:
        raise ValueError("not a whole number of steps")
    t = np.arange(N + 1) * h
    q, v = [np.array(q0, dtype=float)], [np.array(v0, dtype=float)]
    for i in range(N):
        q_next, v_next = step(accel, i * h, q[i], v[i], h)
        q.append(q_next)
        v.append(v_next)
    return t, np.array(q, dtype=np.float32), np.array(v, dtype=np.float32)
