"""The impulse acts against the relative velocity instead of along the normal."""


def resolve(ma, mb, va, vb, normal, restitution):
    u = va - vb
    closing = u @ normal
    if closing <= 0:
        return va, vb
    impulse = (1 + restitution) * closing / (1 / ma + 1 / mb) * u / np.linalg.norm(u)
    return va - impulse / ma, vb + impulse / mb
