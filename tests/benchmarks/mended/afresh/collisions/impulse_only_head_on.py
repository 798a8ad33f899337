"""Bodies that move the same way do not collide."""


def impulse_1d(ma, mb, va, vb, restitution):
    if va * vb > 0 or va <= vb:
        return 0.0
    reduced = 1.0 / (1.0 / ma + 1.0 / mb)
    return (1 + restitution) * reduced * (va - vb)
