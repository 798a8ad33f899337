"""Each radius is squared separately."""


def time_of_impact(xa, va, ra, xb, vb, rb, dt):
    x, v = xb - xa, vb - va
    a, b, c = v @ v, x @ v, x @ x - (ra**2 + rb**2)
    if b >= 0:
        return None
    if c <= 0:
        return 0.0
    if b * b < a * c:
        return None
    t = (-b - math.sqrt(b * b - a * c)) / a
    return float(t) if t <= dt else None
