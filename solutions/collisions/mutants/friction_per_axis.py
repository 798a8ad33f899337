"""Each coordinate of the tangential impulse is limited by itself."""


def resolve_with_friction(ma, mb, va, vb, normal, restitution, mu):
    closing = (va - vb) @ normal
    if closing <= 0:
        return va, vb
    give = 1 / ma + 1 / mb
    press = (1 + restitution) * closing / give
    slip = vb - va + closing * normal
    speed = np.linalg.norm(slip)
    blow = press * normal - np.clip(slip / give, -mu * press, mu * press)
    return va - blow / ma, vb + blow / mb
