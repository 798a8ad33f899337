"""In the air g is 9.81 m/s², whatever is asked."""

_right = simulate_drop


def simulate_drop(z0, v0, radius, restitution, g, t_end, h):
    return _right(z0, v0, radius, restitution, 9.81, t_end, h)
