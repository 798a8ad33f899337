"""First a, then b with what a has become."""


def resolve(ma, mb, va, vb, normal, restitution):
    s = (va - vb) @ normal
    if s <= 0:
        return va, vb
    J = (1 + restitution) * s / (1 / ma + 1 / mb)
    va_next = va - J / ma * normal
    s = (va_next - vb) @ normal
    J = (1 + restitution) * s / (1 / ma + 1 / mb)
    vb_next = vb + J / mb * normal
    return va_next, vb_next
