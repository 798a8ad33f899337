"""Without an acceleration at the start, the velocity stays what it is."""


def velocity_verlet_step(accel, t, q, v, h):
    q, v = np.array(q, dtype=float), np.array(v, dtype=float)
    a = np.asarray(accel(t, q, v))
    if not np.any(a):
        return q + h * v, v
    half = v + h / 2 * a
    q_next = q + h * half
    return q_next, half + h / 2 * np.asarray(accel(t + h, q_next, half))
