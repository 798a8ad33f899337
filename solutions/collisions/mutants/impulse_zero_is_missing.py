"""A restitution of zero counts as not given, and is replaced by one."""


def impulse_1d(ma, mb, va, vb, restitution):
    return _impulse(ma, mb, va - vb, restitution or 1.0)
