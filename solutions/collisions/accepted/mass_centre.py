"""Impacts seen from the centre of mass, where each velocity along the normal is simply reversed."""


def _shares(ma, mb):
    """Weights of the two velocities in that of the centre of mass, infinite masses included."""
    if math.isinf(ma):
        return 1.0, 0.0
    if math.isinf(mb):
        return 0.0, 1.0
    return ma / (ma + mb), mb / (ma + mb)


def impulse_1d(ma, mb, va, vb, restitution):
    if not va > vb:
        return 0.0
    wa, wb = _shares(ma, mb)
    centre = wa * va + wb * vb
    if math.isinf(mb):
        return ma * (1 + restitution) * (va - centre)
    return mb * (1 + restitution) * (centre - vb)


def resolve(ma, mb, va, vb, normal, restitution):
    va, vb, n = np.array(va, float), np.array(vb, float), np.array(normal, float)
    if np.dot(va - vb, n) <= 0:
        return va, vb
    wa, wb = _shares(ma, mb)
    centre = (wa * va + wb * vb) @ n
    return va - (1 + restitution) * (va @ n - centre) * n, vb - (1 + restitution) * (vb @ n - centre) * n
