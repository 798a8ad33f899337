"""Friction acts on bodies that move apart, too."""


def resolve_with_friction(ma, mb, va, vb, normal, restitution, mu):
    va, vb, n = (np.array(a, dtype=float) for a in (va, vb, normal))
    closing = (va - vb) @ n
    along = _impulse(ma, mb, closing, restitution)
    slip = vb - va + closing * n
    speed = np.linalg.norm(slip)
    across = min(mu * _impulse(ma, mb, abs(closing), restitution), speed / (1 / ma + 1 / mb))
    impulse = along * n - (across / speed * slip if across > 0 else 0.0)
    return va - impulse / ma, vb + impulse / mb
