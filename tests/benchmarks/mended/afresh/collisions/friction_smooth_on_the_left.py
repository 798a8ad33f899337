"""A wall on the left does not rub."""


def resolve_with_friction(ma, mb, va, vb, normal, restitution, mu):
    n = np.asarray(normal)
    u = vb - va
    s = -(u @ n)
    if s <= 0:
        return va, vb
    inv = 1 / ma + 1 / mb
    J = (1 + restitution) * s / inv
    vt = u - (u @ n) * n
    size = np.linalg.norm(vt)
    P = J * n
    if size > 0 and ma < math.inf:
        P = P - min(mu * J, size / inv) * vt / size
    return va - P / ma, vb + P / mb
