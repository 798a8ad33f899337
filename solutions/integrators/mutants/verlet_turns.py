"""The acceleration is asked for at a position between -pi and pi."""

_right = velocity_verlet_step


def velocity_verlet_step(accel, t, q, v, h):
    return _right(lambda t, q, v: accel(t, (np.asarray(q) + np.pi) % (2 * np.pi) - np.pi, v), t, q, v, h)
