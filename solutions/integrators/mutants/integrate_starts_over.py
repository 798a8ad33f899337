"""Every step starts from the initial state."""


def integrate(step, accel, q0, v0, t_end, h):
    n = round(t_end / h)
    if abs(t_end / h - n) > 1e-6:
        raise ValueError
    q0, v0 = np.array(q0, float), np.array(v0, float)
    states = [(q0, v0)] + [step(accel, i * h, q0, v0, h) for i in range(n)]
    return h * np.arange(n + 1), np.array([s[0] for s in states]), np.array([s[1] for s in states])
