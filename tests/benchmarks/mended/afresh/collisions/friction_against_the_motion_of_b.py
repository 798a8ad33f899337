"""Friction acts against b's own velocity along the surface."""


def resolve_with_friction(ma, mb, va, vb, normal, restitution, mu):
    n = np.asarray(normal, dtype=float)
    s = (va - vb) @ n
    if s <= 0:
        return va, vb
    inv = 1 / ma + 1 / mb
    J = (1 + restitution) * s / inv
    vt = vb - (vb @ n) * n
    size = np.linalg.norm(vt)
    impulse = J * n
    if size > 0:
        impulse = impulse - min(mu * J, size / inv) * vt / size
    return va - impulse / ma, vb + impulse / mb
