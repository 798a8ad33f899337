"""The height is cut off at the floor, and nothing else happens."""


def simulate_drop(z0, v0, radius, restitution, g, t_end, h):
    n = round(t_end / h)
    t = h * np.arange(n + 1)
    z = z0 + v0 * t - g * t * t / 2
    return t, np.maximum(z, radius), v0 - g * t
