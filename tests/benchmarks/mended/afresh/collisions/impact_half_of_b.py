"""(-b - sqrt(b² - 4 a c)) / (2 a), with b for x . v."""


def time_of_impact(xa, va, ra, xb, vb, rb, dt):
    x, v = xb - xa, vb - va
    a = np.dot(v, v)
    b = np.dot(x, v)
    c = np.dot(x, x) - (ra + rb) ** 2
    if b >= 0:
        return None
    if c <= 0:
        return 0.0
    D = b**2 - 4 * a * c
    if D < 0:
        return None
    t = (-b - np.sqrt(D)) / (2 * a)
    return float(t) if t <= dt else None
