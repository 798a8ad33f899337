"""s = vb - va."""


def impulse_1d(ma, mb, va, vb, restitution):
    s = vb - va
    return (1 + restitution) * s / (1 / ma + 1 / mb) if s > 0 else 0.0
