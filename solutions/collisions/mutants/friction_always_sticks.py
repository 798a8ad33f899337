"""Every slip is stopped, whatever mu (unless it is zero)."""


def resolve_with_friction(ma, mb, va, vb, normal, restitution, mu):
    closing = (va - vb) @ normal
    if closing <= 0:
        return va, vb
    give = 1 / ma + 1 / mb
    along = (1 + restitution) * closing / give
    slip = vb - va + closing * normal
    speed = np.linalg.norm(slip)
    impulse = along * normal - (slip / give if mu else 0.0)
    return va - impulse / ma, vb + impulse / mb
