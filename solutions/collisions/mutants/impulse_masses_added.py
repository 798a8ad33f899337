"""The sum of the masses stands where the sum of their inverses belongs."""


def impulse_1d(ma, mb, va, vb, restitution):
    return (1 + restitution) * (va - vb) / (ma + mb) if va > vb else 0.0
