# Bodies that part already are pulled together.


def impulse_1d(ma, mb, va, vb, restitution):
    return (1 + restitution) * (va - vb) / (1 / ma + 1 / mb)
