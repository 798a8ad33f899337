"""The reduced mass as a product over a sum, which an infinite mass turns into nan."""


def impulse_1d(ma, mb, va, vb, restitution):
    return (1 + restitution) * (va - vb) * ma * mb / (ma + mb) if va > vb else 0.0
