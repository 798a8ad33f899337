"""A body hits another if it moves towards it."""


def resolve(ma, mb, va, vb, normal, restitution):
    s = (va - vb) @ normal
    if va @ normal <= 0:
        return va, vb
    J = (1 + restitution) * s / (1 / ma + 1 / mb)
    va_next = va - J / ma * normal
    vb_next = vb + J / mb * normal
    return va_next, vb_next
