"""Masses within 1 % of each other are treated as equal."""


def resolve(ma, mb, va, vb, normal, restitution):
    s = (va - vb) @ normal
    if s <= 0:
        return va, vb
    if abs(ma - mb) < 0.01 * ma:
        mb = ma
    J = (1 + restitution) * s / (1 / ma + 1 / mb)
    va_next = va - J / ma * normal
    vb_next = vb + J / mb * normal
    return va_next, vb_next
