"""integrate calls itself instead of using a loop."""


def integrate(step, accel, q0, v0, t_end, h):
    n = round(t_end / h)
    if abs(t_end / h - n) > 1e-6:
        raise ValueError("t_end must be a whole number of steps")

    def path(i, q, v):
        here = [(i * h, q, v)]
        return here if i == n else here + path(i + 1, *step(accel, i * h, q, v, h))

    t, q, v = zip(*path(0, np.array(q0, float), np.array(v0, float)))
    return np.array(t), np.array(q), np.array(v)
