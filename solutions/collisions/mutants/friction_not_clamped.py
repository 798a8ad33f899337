"""The impulse of friction is mu J even where less would stop the slip."""


def resolve_with_friction(ma, mb, va, vb, normal, restitution, mu):
    closing = (va - vb) @ normal
    if closing <= 0:
        return va, vb
    give = 1 / ma + 1 / mb
    along = (1 + restitution) * closing / give
    slip = vb - va + closing * normal
    speed = np.linalg.norm(slip)
    impulse = along * normal - (mu * along * slip / speed if speed else 0.0)
    return va - impulse / ma, vb + impulse / mb
