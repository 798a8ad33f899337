"""The direction of the slip is computed even where nothing slides."""


def resolve_with_friction(ma, mb, va, vb, normal, restitution, mu):
    closing = (va - vb) @ normal
    if closing <= 0:
        return va, vb
    give = 1 / ma + 1 / mb
    press = (1 + restitution) * closing / give
    slip = vb - va + closing * normal
    speed = np.linalg.norm(slip)
    blow = press * normal - min(mu * press, speed / give) * slip / speed
    return va - blow / ma, vb + blow / mb
