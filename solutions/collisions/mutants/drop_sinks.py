"""Slow contacts are ignored, and gravity keeps acting."""

_right = simulate_drop


def simulate_drop(z0, v0, radius, restitution, g, t_end, h):
    t, z, v = _right(z0, v0, radius, restitution, g, t_end, h)
    still = v == 0.0
    still[0] = v0 == 0.0 and z0 == radius
    if still.any():
        s = np.maximum(t - t[np.argmax(still)], 0.0)
        z, v = z - g * s * s / 2, v - g * s
    return t, z, v
