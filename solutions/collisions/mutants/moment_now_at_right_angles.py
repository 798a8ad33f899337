"""Spheres that overlap touch now unless they move apart, so also if they come no nearer."""


def time_of_impact(xa, va, ra, xb, vb, rb, dt):
    x, v = np.subtract(xb, xa, dtype=float), np.subtract(vb, va, dtype=float)
    nearing = -(x @ v)
    if nearing < 0:
        return None
    a, b, c = v @ v, nearing, x @ x - (ra + rb) ** 2
    if c <= 0:
        return 0.0
    if a == 0 or b * b < a * c:
        return None
    t = c / (b + math.sqrt(b * b - a * c))
    return float(t) if t <= dt else None
