"""b = 2 x . v beside b² - a c."""


def time_of_impact(xa, va, ra, xb, vb, rb, dt):
    x = xb - xa
    v = vb - va
    R = ra + rb
    a = v @ v
    b = 2 * (x @ v)
    c = x @ x - R * R
    if b >= 0:
        return None
    if c < 0:
        return 0.0
    disc = b * b - a * c
    if disc < 0:
        return None
    t = (-b - np.sqrt(disc)) / (2 * a)
    return t if t <= dt else None
