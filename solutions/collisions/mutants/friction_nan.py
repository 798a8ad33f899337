"""The direction of the slip is computed even where nothing slides."""


def resolve_with_friction(ma, mb, va, vb, normal, restitution, mu):
    closing = (va - vb) @ normal
    if closing <= 0:
        return va, vb
    give = 1 / ma + 1 / mb
    along = (1 + restitution) * closing / give
    slip = vb - va + closing * normal
    speed = np.linalg.norm(slip)
    impulse = along * normal - min(mu * along, speed / give) * slip / speed
    return va - impulse / ma, vb + impulse / mb
