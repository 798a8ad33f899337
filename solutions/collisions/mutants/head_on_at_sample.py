"""The impact comes at the first sample at which the balls overlap, as in most engines."""


def simulate_head_on(m, x0, v0, radius, restitution, t_end, h):
    n = round(t_end / h)
    x, v = np.array(x0, float), np.array(v0, float)
    rows = [(x, v)]
    for i in range(n):
        x = x + v * h
        if x[1] - x[0] <= 2 * radius and v[0] > v[1]:
            j = (1 + restitution) * (v[0] - v[1]) / (1 / m[0] + 1 / m[1])
            v = v + np.array([-j / m[0], j / m[1]])
        rows.append((x, v))
    return h * np.arange(n + 1), np.array([r[0] for r in rows]), np.array([r[1] for r in rows])
