"""One contact in each step, for ever: the bounces get smaller, and the ball is never put to rest."""


def simulate_drop(z0, v0, radius, restitution, g, t_end, h):
    n = round(t_end / h)
    rows, z, v = [(z0, v0)], z0, v0
    for i in range(n):
        ahead = z + v * h - g * h * h / 2
        if ahead < radius:
            speed = math.sqrt(v * v + 2 * g * max(z - radius, 0.0))
            left = max(h - (v + speed) / g, 0.0)
            up = max(restitution * speed, g * left / 2)
            ahead, v = radius + up * left - g * left * left / 2, up - g * left + g * h
        z, v = ahead, v - g * h
        rows.append((z, v))
    return h * np.arange(n + 1), [r[0] for r in rows], [r[1] for r in rows]
