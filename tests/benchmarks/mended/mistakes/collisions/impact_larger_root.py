# The later of the two roots.


def time_of_impact(xa, va, ra, xb, vb, rb, dt):
    x, v = np.subtract(xb, xa, dtype=float), np.subtract(vb, va, dtype=float)
    R = ra + rb
    a, b, c = v @ v, 2 * (x @ v), x @ x - R**2
    if b >= 0:
        return None
    if c <= 0:
        return 0.0
    root = b * b - 4 * a * c
    if root < 0:
        return None
    t = (-b + math.sqrt(root)) / (2 * a)
    return float(t) if t <= dt else None
