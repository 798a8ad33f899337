"""Bodies of the same mass exchange their velocities, whatever e is."""

_right = impulse_1d


def impulse_1d(ma, mb, va, vb, restitution):
    return _right(ma, mb, va, vb, 1.0 if ma == mb else restitution)
