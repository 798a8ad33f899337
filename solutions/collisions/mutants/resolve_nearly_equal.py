"""Masses that differ by less than 1 % are taken to be equal."""


def resolve(ma, mb, va, vb, normal, restitution):
    va, vb, n = (np.array(a, dtype=float) for a in (va, vb, normal))
    other = ma if abs(ma - mb) < 0.01 * ma else mb
    impulse = _impulse(ma, other, (va - vb) @ n, restitution) * n
    return va - impulse / ma, vb + impulse / other
