"""int() instead of round()."""

_right_drop = simulate_drop


def simulate_drop(z0, v0, radius, restitution, g, t_end, h):
    return _right_drop(z0, v0, radius, restitution, g, int(t_end / h) * h, h)
