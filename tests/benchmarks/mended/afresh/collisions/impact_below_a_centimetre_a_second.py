"""Pairs with a relative speed below 1 cm/s are taken to be at rest."""


def time_of_impact(xa, va, ra, xb, vb, rb, dt):
    x = xb - xa
    v = vb - va
    R = ra + rb
    b = x @ v
    if b >= 0:
        return None
    c = x @ x - R**2
    if c <= 0:
        return 0.0
    a = v @ v
    if a < 1e-4:
        return None
    disc = b**2 - a * c
    if disc < 0:
        return None
    t = c / (-b + math.sqrt(disc))
    if t <= dt:
        return float(t)
    return None
