# 1 - e instead of 1 + e.


def impulse_1d(ma, mb, va, vb, restitution):
    if va <= vb:
        return 0.0
    return (1 - restitution) * (va - vb) / (1 / ma + 1 / mb)
