"""Where spheres overlap already, the time at which they began to is returned."""


def time_of_impact(xa, va, ra, xb, vb, rb, dt):
    x, v = np.subtract(xb, xa, dtype=float), np.subtract(vb, va, dtype=float)
    a, b, c = v @ v, x @ v, x @ x - (ra + rb) ** 2
    if b >= 0 or b * b < a * c:
        return None
    t = (-b - math.sqrt(b * b - a * c)) / a
    return float(t) if t <= dt else None
