"""The masses are exchanged when J is applied."""


def resolve(ma, mb, va, vb, normal, restitution):
    s = (va - vb) @ normal
    if s <= 0:
        return va, vb
    J = (1 + restitution) * s / (1 / ma + 1 / mb)
    return va - J / mb * normal, vb + J / ma * normal
