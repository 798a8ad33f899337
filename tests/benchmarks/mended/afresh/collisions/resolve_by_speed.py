"""How fast they approach is the size of their relative velocity."""


def resolve(ma, mb, va, vb, normal, restitution):
    rel = va - vb
    if rel @ normal <= 0:
        return va, vb
    s = np.linalg.norm(rel)
    J = (1 + restitution) * s / (1 / ma + 1 / mb)
    return va - J / ma * normal, vb + J / mb * normal
