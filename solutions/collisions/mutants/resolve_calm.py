"""Below a speed of approach of 1 cm/s there is no rebound."""


def resolve(ma, mb, va, vb, normal, restitution):
    va, vb, n = (np.array(a, dtype=float) for a in (va, vb, normal))
    closing = max((va - vb) @ n, 0.0)
    e = restitution if closing > 0.01 else 0.0
    impulse = (1 + e) * closing / (1 / ma + 1 / mb) * n
    return va - impulse / ma, vb + impulse / mb
