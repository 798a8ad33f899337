"""int() instead of round()."""

_right = simulate_head_on


def simulate_head_on(m, x0, v0, radius, restitution, t_end, h):
    return _right(m, x0, v0, radius, restitution, int(t_end / h) * h, h)
