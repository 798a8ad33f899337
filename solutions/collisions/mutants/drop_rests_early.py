"""The ball is put to rest at its second contact."""

_right = simulate_drop


def simulate_drop(z0, v0, radius, restitution, g, t_end, h):
    t, z, v = _right(z0, v0, radius, restitution, g, t_end, h)
    speed = math.sqrt(v0 * v0 + 2 * g * (z0 - radius))
    late = t > (v0 + speed) / g + 2 * restitution * speed / g
    return t, np.where(late, radius, z), np.where(late, 0.0, v)
