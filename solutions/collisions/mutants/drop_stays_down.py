"""A ball that touches the floor at the start is taken to lie on it."""

_right_drop = simulate_drop


def simulate_drop(z0, v0, radius, restitution, g, t_end, h):
    t, z, v = _right_drop(z0, v0, radius, restitution, g, t_end, h)
    if z0 <= radius:
        z[1:], v[1:] = radius, 0.0
    return t, z, v
