"""Both simulations without a loop over steps: contacts first, then every sample from its own formula."""


def simulate_head_on(m, x0, v0, radius, restitution, t_end, h):
    t = np.linspace(0.0, t_end, round(t_end / h) + 1)
    (xa, xb), (va, vb) = x0, v0
    met = (xb - xa - 2 * radius) / (va - vb) if va > vb else math.inf
    j = impulse_1d(*m, va, vb, restitution)
    before, after = np.minimum(t, met)[:, None], np.maximum(t - met, 0.0)[:, None]
    v1 = np.array([va - j / m[0], vb + j / m[1]])
    v = np.where(t[:, None] < met, v0, v1)
    return t, np.array(x0) + np.array(v0) * before + v1 * after, v


def simulate_drop(z0, v0, radius, restitution, g, t_end, h):
    t = np.arange(round(t_end / h) + 1) * h
    up = math.hypot(v0, math.sqrt(2 * g * (z0 - radius)))
    arcs, start = [(0.0, z0, v0)], (v0 + up) / g
    while start < t_end and arcs[-1][2] is not None:
        up *= restitution
        rests = up <= g * h
        arcs.append((start, radius, None if rests else up))
        start += 2 * up / g
    z, v = np.empty_like(t), np.empty_like(t)
    for begin, height, speed in arcs:
        s = t - begin
        later = s >= 0
        z[later] = height + (0.0 if speed is None else speed * s[later] - g * s[later] ** 2 / 2)
        v[later] = 0.0 if speed is None else speed - g * s[later]
    return t, z, v
