"""Friction acts on b only."""


def resolve_with_friction(ma, mb, va, vb, normal, restitution, mu):
    closing = (va - vb) @ normal
    if closing <= 0:
        return va, vb
    give = 1 / ma + 1 / mb
    along = (1 + restitution) * closing / give
    slip = vb - va + closing * normal
    speed = np.linalg.norm(slip)
    across = min(mu * along, speed / give) * slip / speed if speed else 0.0 * slip
    return va - along * normal / ma, vb + (along * normal - across) / mb
