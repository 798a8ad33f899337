"""The speed is multiplied by 1/ma + 1/mb, not divided by it."""


def impulse_1d(ma, mb, va, vb, restitution):
    s = va - vb
    if s <= 0:
        return 0.0
    return (1 + restitution) * s * (1 / ma + 1 / mb)
