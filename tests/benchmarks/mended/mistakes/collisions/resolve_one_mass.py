# Both velocities change by J/ma.


def resolve(ma, mb, va, vb, normal, restitution):
    va, vb, n = np.array(va, dtype=float), np.array(vb, dtype=float), np.array(normal, dtype=float)
    s = (va - vb) @ n
    if s <= 0:
        return va, vb
    J = (1 + restitution) * s / (1 / ma + 1 / mb)
    return va - J / ma * n, vb + J / ma * n
