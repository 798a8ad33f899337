"""No contact is not a number."""


def time_of_impact(xa, va, ra, xb, vb, rb, dt):
    x, v = np.subtract(xb, xa), np.subtract(vb, va)
    if x @ v >= 0:
        return math.nan
    if x @ x < (ra + rb) ** 2:
        return 0.0
    a, b, c = v @ v, x @ v, x @ x - (ra + rb) ** 2
    if b * b < a * c:
        return None
    t = (-b - math.sqrt(b * b - a * c)) / a
    return t if t <= dt else None
