"""A body of infinite mass is taken to be at rest."""

_right = resolve


def resolve(ma, mb, va, vb, normal, restitution):
    if np.isinf(ma):
        return va, _right(ma, mb, 0 * va, vb, normal, restitution)[1]
    if np.isinf(mb):
        return _right(ma, mb, va, 0 * vb, normal, restitution)[0], vb
    return _right(ma, mb, va, vb, normal, restitution)
