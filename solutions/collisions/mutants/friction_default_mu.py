"""A coefficient of zero is replaced."""


def resolve_with_friction(ma, mb, va, vb, normal, restitution, mu):
    mu = mu or 0.5
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
    if size > 0:
        P = P - min(mu * J, size / inv) * vt / size
    return va - P / ma, vb + P / mb
