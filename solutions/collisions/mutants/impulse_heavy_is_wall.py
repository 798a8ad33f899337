"""A body that is ten thousand times as heavy as the other is taken for a wall."""


def impulse_1d(ma, mb, va, vb, restitution):
    if max(ma, mb) > 1e4 * min(ma, mb):
        ma = mb = 2 * min(ma, mb)
    return _impulse(ma, mb, va - vb, restitution)
