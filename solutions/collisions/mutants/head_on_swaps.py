"""One mass is used for both balls."""

_right = simulate_head_on


def simulate_head_on(m, x0, v0, radius, restitution, t_end, h):
    t = h * np.arange(round(t_end / h) + 1)
    x0, v0 = np.array(x0, float), np.array(v0, float)
    closing = v0[0] - v0[1]
    met = (x0[1] - x0[0] - 2 * radius) / closing if closing > 0 else math.inf
    j = (1 + restitution) * closing * m[0] / 2
    v1 = v0 + np.array([-j / m[0], j / m[1]])
    s = t[:, None]
    return t, x0 + v0 * np.minimum(s, met) + v1 * np.maximum(s - met, 0), np.where(s < met, v0, v1)
