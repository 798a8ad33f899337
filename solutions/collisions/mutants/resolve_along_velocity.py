"""The blow acts against the relative velocity instead of along the normal."""


def resolve(ma, mb, va, vb, normal, restitution):
    u = va - vb
    closing = u @ normal
    if closing <= 0:
        return va, vb
    blow = (1 + restitution) * closing / (1 / ma + 1 / mb) * u / np.linalg.norm(u)
    return va - blow / ma, vb + blow / mb
