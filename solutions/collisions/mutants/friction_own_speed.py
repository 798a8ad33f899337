"""The slip is computed from a's velocity alone, as if b stood still."""


def resolve_with_friction(ma, mb, va, vb, normal, restitution, mu):
    closing = (va - vb) @ normal
    if closing <= 0:
        return va, vb
    give = 1 / ma + 1 / mb
    along = (1 + restitution) * closing / give
    slip = (va @ normal) * normal - va
    speed = np.linalg.norm(slip)
    across = min(mu * along, speed / give) * slip / speed if speed else 0.0 * slip
    impulse = along * normal - across
    return va - impulse / ma, vb + impulse / mb
