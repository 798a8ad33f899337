"""Each coordinate of the tangential impulse is limited separately."""


def resolve_with_friction(ma, mb, va, vb, normal, restitution, mu):
    closing = (va - vb) @ normal
    if closing <= 0:
        return va, vb
    give = 1 / ma + 1 / mb
    along = (1 + restitution) * closing / give
    slip = vb - va + closing * normal
    speed = np.linalg.norm(slip)
    impulse = along * normal - np.clip(slip / give, -mu * along, mu * along)
    return va - impulse / ma, vb + impulse / mb
