"""The ball waits on the floor until the step is over."""


def simulate_drop(z0, v0, radius, restitution, g, t_end, h):
    n = round(t_end / h)
    rows, z, v = [(z0, v0)], z0, v0
    for i in range(n):
        ahead = z + v * h - g * h * h / 2
        if ahead < radius:
            z, v = radius, restitution * math.sqrt(v * v + 2 * g * max(z - radius, 0.0))
            v = v if v > g * h else 0.0
        else:
            z, v = ahead, v - g * h
        rows.append((z, v))
    return h * np.arange(n + 1), [r[0] for r in rows], [r[1] for r in rows]
