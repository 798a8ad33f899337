"""Friction also acts on separating bodies, with the size of s, although nothing happens to them."""


def resolve_with_friction(ma, mb, va, vb, normal, restitution, mu):
    s = (va - vb) @ normal
    w = 1 / ma + 1 / mb
    limit = mu * (1 + restitution) * abs(s) / w
    J = max(0.0, (1 + restitution) * s / w)
    va_next = va - J / ma * normal
    vb_next = vb + J / mb * normal
    u = vb - va
    vt = u - (u @ normal) * normal
    slip = np.linalg.norm(vt)
    if slip > 0:
        Jt = min(limit, slip / w)
        direction = -vt / slip
        va_next = va_next - Jt / ma * direction
        vb_next = vb_next + Jt / mb * direction
    return va_next, vb_next
