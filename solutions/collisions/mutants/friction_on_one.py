"""Friction acts on b only."""


def resolve_with_friction(ma, mb, va, vb, normal, restitution, mu):
    closing = (va - vb) @ normal
    if closing <= 0:
        return va, vb
    give = 1 / ma + 1 / mb
    press = (1 + restitution) * closing / give
    slip = vb - va + closing * normal
    speed = np.linalg.norm(slip)
    rub = min(mu * press, speed / give) * slip / speed if speed else 0.0 * slip
    return va - press * normal / ma, vb + (press * normal - rub) / mb
