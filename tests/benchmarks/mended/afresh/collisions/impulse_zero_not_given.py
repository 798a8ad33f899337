"""A restitution of 0 counts as not given and is replaced by 1."""


def impulse_1d(ma, mb, va, vb, restitution):
    e = restitution or 1.0
    s = va - vb
    if s <= 0:
        return 0.0
    return (1 + e) * s / (1 / ma + 1 / mb)
