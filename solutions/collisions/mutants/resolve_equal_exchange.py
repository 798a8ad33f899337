"""Bodies of the same mass exchange their velocities along the normal, whatever e is."""

_right = resolve


def resolve(ma, mb, va, vb, normal, restitution):
    return _right(ma, mb, va, vb, normal, 1.0 if ma == mb else restitution)
