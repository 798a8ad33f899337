"""Beside each position stands the velocity from before its step."""


def simulate_head_on(m, x0, v0, radius, restitution, t_end, h):
    N = round(t_end / h)
    t = np.arange(N + 1) * h
    x, v = np.zeros((N + 1, 2)), np.zeros((N + 1, 2))
    x[0], v[0] = x0, v0
    speed = np.array(v0, dtype=float)
    for i in range(N):
        v[i + 1] = speed
        closing = speed[0] - speed[1]
        gap = x[i, 1] - x[i, 0] - 2 * radius
        tau = h
        if closing > 0 and gap <= closing * h:
            tau = max(gap, 0) / closing
            J = impulse_1d(m[0], m[1], speed[0], speed[1], restitution)
            after = speed + np.array([-J / m[0], J / m[1]])
        else:
            after = speed
        x[i + 1] = x[i] + speed * tau + after * (h - tau)
        speed = after
    return t, x, v
