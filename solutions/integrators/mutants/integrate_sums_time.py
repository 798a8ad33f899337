"""The loop's condition compares a running sum with t_end."""


def integrate(step, accel, q0, v0, t_end, h):
    if abs(t_end / h - round(t_end / h)) > 1e-6:
        raise ValueError
    t, q, v = [0.0], [np.array(q0, float)], [np.array(v0, float)]
    while t[-1] < t_end:
        q_next, v_next = step(accel, t[-1], q[-1], v[-1], h)
        t.append(t[-1] + h)
        q.append(q_next)
        v.append(v_next)
    return np.array(t), np.array(q), np.array(v)
