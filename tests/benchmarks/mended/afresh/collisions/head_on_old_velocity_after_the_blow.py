"""The blow changes the velocities; the step is finished with those it began with."""


def simulate_head_on(m, x0, v0, radius, restitution, t_end, h):
    n = round(t_end / h)
    x, v = np.array(x0, dtype=float), np.array(v0, dtype=float)
    t, xs, vs = [0.0], [x], [v]
    for i in range(n):
        gap = x[1] - x[0] - 2 * radius
        closing = v[0] - v[1]
        old = v
        if closing > 0 and gap - closing * h <= 0:
            J = (1 + restitution) * closing / (1 / m[0] + 1 / m[1])
            v = v + np.array([-J / m[0], J / m[1]])
        x = x + old * h
        t.append((i + 1) * h)
        xs.append(x)
        vs.append(v)
    return np.array(t), np.array(xs), np.array(vs)
