"""Friction is mu times the speed of approach."""


def resolve_with_friction(ma, mb, va, vb, normal, restitution, mu):
    u = vb - va
    un = float(u @ normal)
    if un >= 0:
        return va, vb
    w = 1 / ma + 1 / mb
    jn = -(1 + restitution) * un / w
    vt = u - un * normal
    slip = float(np.linalg.norm(vt))
    p = jn * normal
    if slip > 1e-15:
        jt = min(mu * -un, slip / w)
        p = p - jt * (vt / slip)
    return va - p / ma, vb + p / mb
