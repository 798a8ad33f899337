"""What stops the slip is slip times both masses."""


def resolve_with_friction(ma, mb, va, vb, normal, restitution, mu):
    s = float(np.dot(va - vb, normal))
    if not s > 0:
        return va, vb
    J = (1 + restitution) * s / (1 / ma + 1 / mb)
    u = vb - va
    vt = u - np.dot(u, normal) * normal
    size = float(np.linalg.norm(vt))
    if size == 0:
        return va - J / ma * normal, vb + J / mb * normal
    Jt = min(mu * J, size * (ma + mb))
    k = vt / size
    return va - J / ma * normal + Jt / ma * k, vb + J / mb * normal - Jt / mb * k
