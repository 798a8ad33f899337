# Friction is always mu J, more than what stops the slip.


def resolve_with_friction(ma, mb, va, vb, normal, restitution, mu):
    va, vb, n = np.array(va, dtype=float), np.array(vb, dtype=float), np.array(normal, dtype=float)
    s = (va - vb) @ n
    if s <= 0:
        return va, vb
    J = (1 + restitution) * s / (1 / ma + 1 / mb)
    u = vb - va
    vt = u - (u @ n) * n
    size = np.linalg.norm(vt)
    tangent = vt / size if size > 0 else 0 * n
    blow = J * n - mu * J * tangent
    return va - blow / ma, vb + blow / mb
