"""In a collision nothing is lost."""


def resolve(ma, mb, va, vb, normal, restitution):
    s = float(np.dot(va - vb, normal))
    if s > 0:
        j = 2 * s / (1 / ma + 1 / mb)
        va = va - (j / ma) * normal
        vb = vb + (j / mb) * normal
    return va, vb
