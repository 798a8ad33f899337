"""Every slip is stopped, whatever mu (unless it is zero)."""


def resolve_with_friction(ma, mb, va, vb, normal, restitution, mu):
    closing = (va - vb) @ normal
    if closing <= 0:
        return va, vb
    give = 1 / ma + 1 / mb
    press = (1 + restitution) * closing / give
    slip = vb - va + closing * normal
    speed = np.linalg.norm(slip)
    blow = press * normal - (slip / give if mu else 0.0)
    return va - blow / ma, vb + blow / mb
