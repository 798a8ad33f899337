"""Bodies that move apart are pulled back together."""


def impulse_1d(ma, mb, va, vb, restitution):
    return (1 + restitution) * (va - vb) / (1 / ma + 1 / mb)
