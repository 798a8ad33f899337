"""The test whether the bodies approach is left out."""


def resolve(ma, mb, va, vb, normal, restitution):
    impulse = (1 + restitution) * ((va - vb) @ normal) / (1 / ma + 1 / mb) * normal
    return va - impulse / ma, vb + impulse / mb
