"""The right formula, written into the caller's own arrays."""


def resolve(ma, mb, va, vb, normal, restitution):
    blow = _impulse(ma, mb, (va - vb) @ normal, restitution) * normal
    va -= blow / ma
    vb += blow / mb
    return va, vb
