# The velocities that were given are changed.


def resolve(ma, mb, va, vb, normal, restitution):
    s = (va - vb) @ normal
    if s > 0:
        J = (1 + restitution) * s / (1 / ma + 1 / mb)
        va -= J / ma * normal
        vb += J / mb * normal
    return va, vb
