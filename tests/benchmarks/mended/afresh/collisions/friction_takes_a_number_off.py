"""The slip is u less u . n."""


def resolve_with_friction(ma, mb, va, vb, normal, restitution, mu):
    s = (va - vb) @ normal
    if s <= 0:
        return va, vb
    w = 1 / ma + 1 / mb
    J = (1 + restitution) * s / w
    va_next = va - J / ma * normal
    vb_next = vb + J / mb * normal
    u = vb - va
    vt = u - (u @ normal)
    slip = np.linalg.norm(vt)
    if slip > 0:
        Jt = min(mu * J, slip / w)
        direction = -vt / slip
        va_next = va_next - Jt / ma * direction
        vb_next = vb_next + Jt / mb * direction
    return va_next, vb_next
