"""The centre falls to the floor."""

_right = simulate_drop


def simulate_drop(z0, v0, radius, restitution, g, t_end, h):
    return _right(z0, v0, 0.0, restitution, g, t_end, h)
