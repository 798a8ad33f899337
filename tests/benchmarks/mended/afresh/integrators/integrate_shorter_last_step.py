"""A duration that is not a whole number is not refused but ends with one shorter step."""


def integrate(step, accel, q0, v0, t_end, h):
    N = math.floor(t_end / h + 1e-6)
    t = [i * h for i in range(N + 1)]
    if t_end - N * h > 1e-6 * h:
        t.append(t_end)
    q, v = [np.array(q0, dtype=float)], [np.array(v0, dtype=float)]
    for now, later in zip(t[:-1], t[1:]):
        q_next, v_next = step(accel, now, q[-1], v[-1], h if later != t_end else later - now)
        q.append(q_next)
        v.append(v_next)
    return np.array(t), np.array(q), np.array(v)
