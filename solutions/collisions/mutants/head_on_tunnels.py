"""The contact is found exactly, but only if the balls overlap at the end of a step."""


def simulate_head_on(m, x0, v0, radius, restitution, t_end, h):
    n = round(t_end / h)
    x, v = np.array(x0, float), np.array(v0, float)
    rows = [(x, v)]
    for i in range(n):
        gap, closing = x[1] - x[0] - 2 * radius, v[0] - v[1]
        ahead, left = x + v * h, h
        if closing > 0 and gap <= closing * h and ahead[1] - ahead[0] > -2 * radius:
            x, left = x + v * (gap / closing), h - gap / closing
            j = (1 + restitution) * (v[0] - v[1]) / (1 / m[0] + 1 / m[1])
            v = v + np.array([-j / m[0], j / m[1]])
        x = x + v * left
        rows.append((x, v))
    return h * np.arange(n + 1), np.array([r[0] for r in rows]), np.array([r[1] for r in rows])
