"""Semi-implicit Euler in the air."""


def simulate_drop(z0, v0, radius, restitution, g, t_end, h):
    n = round(t_end / h)
    rows, z, v = [(z0, v0)], z0, v0
    for i in range(n):
        v = v - g * h
        z = z + v * h
        if z <= radius and v < 0:
            v = -restitution * v
            if v <= g * h:
                z, v = radius, 0.0
        rows.append((z, v))
    return h * np.arange(n + 1), [r[0] for r in rows], [r[1] for r in rows]
