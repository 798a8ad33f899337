"""Exact in the air; a ball below the floor is lifted up to it, and its velocity is reversed."""


def simulate_drop(z0, v0, radius, restitution, g, t_end, h):
    n = round(t_end / h)
    rows, z, v = [(z0, v0)], z0, v0
    for i in range(n):
        z, v = z + v * h - g * h * h / 2, v - g * h
        if z < radius and v < 0:
            z, v = radius, -restitution * v
            if v <= g * h:
                v = 0.0
        rows.append((z, v))
    return h * np.arange(n + 1), [r[0] for r in rows], [r[1] for r in rows]
