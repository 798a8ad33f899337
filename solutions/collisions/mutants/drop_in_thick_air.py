"""The air slows the ball down."""


def simulate_drop(z0, v0, radius, restitution, g, t_end, h):
    n = round(t_end / h)
    t, z, v = h * np.arange(n + 1), np.empty(n + 1), np.empty(n + 1)
    z[0], v[0] = z0, v0
    for i in range(n):
        a = -g - 0.05 * v[i] * abs(v[i])
        z[i + 1], v[i + 1] = z[i] + v[i] * h + a * h * h / 2, v[i] + a * h
        if z[i + 1] < radius:
            z[i + 1], v[i + 1] = radius, restitution * abs(v[i + 1])
    return t, z, v
