# Without slip its direction is zero over zero.


def resolve_with_friction(ma, mb, va, vb, normal, restitution, mu):
    va, vb, n = np.array(va, dtype=float), np.array(vb, dtype=float), np.array(normal, dtype=float)
    s = (va - vb) @ n
    if s <= 0:
        return va, vb
    inverse = 1 / ma + 1 / mb
    J = (1 + restitution) * s / inverse
    u = vb - va
    vt = u - (u @ n) * n
    size = np.linalg.norm(vt)
    Jt = min(mu * J, size / inverse)
    blow = J * n - Jt * vt / size
    return va - blow / ma, vb + blow / mb
