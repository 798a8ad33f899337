"""Friction acts along the slip."""


def resolve_with_friction(ma, mb, va, vb, normal, restitution, mu):
    closing = (va - vb) @ normal
    if closing <= 0:
        return va, vb
    give = 1 / ma + 1 / mb
    press = (1 + restitution) * closing / give
    slip = vb - va + closing * normal
    speed = np.linalg.norm(slip)
    rub = min(mu * press, speed / give)
    blow = press * normal + (rub * slip / speed if speed else 0.0)
    return va - blow / ma, vb + blow / mb
