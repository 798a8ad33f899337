"""The right formula, written into the caller's own arrays."""


def resolve(ma, mb, va, vb, normal, restitution):
    impulse = _impulse(ma, mb, (va - vb) @ normal, restitution) * normal
    va -= impulse / ma
    vb += impulse / mb
    return va, vb
