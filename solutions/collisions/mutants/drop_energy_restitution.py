"""The ball rises again to e times its height."""

_right = simulate_drop


def simulate_drop(z0, v0, radius, restitution, g, t_end, h):
    return _right(z0, v0, radius, math.sqrt(restitution), g, t_end, h)
