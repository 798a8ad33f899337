"""The radii are taken five per cent smaller, so that balls surely overlap."""


def time_of_impact(xa, va, ra, xb, vb, rb, dt):
    R = 0.95 * (ra + rb)
    x, v = np.subtract(xb, xa), np.subtract(vb, va)
    if x @ v >= 0:
        return None
    if x @ x < R**2:
        return 0.0
    a, b, c = v @ v, x @ v, x @ x - R**2
    if b * b < a * c:
        return None
    t = (-b - math.sqrt(b * b - a * c)) / a
    return t if t <= dt else None
