"""The fraction of dt is returned instead of seconds."""


def time_of_impact(xa, va, ra, xb, vb, rb, dt):
    x, v, R = xb - xa, vb - va, ra + rb
    if x @ v >= 0:
        return None
    a, b, c = v @ v, 2 * (x @ v), x @ x - R**2
    if c < 0:
        return 0.0
    disc = b * b - 4 * a * c
    if disc < 0:
        return None
    t = 2 * c / (-b + math.sqrt(disc))
    return t / dt if t <= dt else None
