"""Separating bodies are given a contact impulse with e = 0 that makes them stick instead of being left alone."""


def resolve(ma, mb, va, vb, normal, restitution):
    s = (va - vb) @ normal
    if s <= 0:
        restitution = 0.0
    J = (1 + restitution) * s / (1 / ma + 1 / mb)
    va_next = va - J / ma * normal
    vb_next = vb + J / mb * normal
    return va_next, vb_next
