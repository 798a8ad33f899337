# The reduced mass as a product over a sum: not a number at a wall.


def impulse_1d(ma, mb, va, vb, restitution):
    if va <= vb:
        return 0.0
    return (1 + restitution) * (va - vb) * ma * mb / (ma + mb)
