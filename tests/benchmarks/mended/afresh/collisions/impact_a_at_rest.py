"""Seen from a, only b moves."""


def time_of_impact(xa, va, ra, xb, vb, rb, dt):
    x = xb - xa
    v = vb
    R = ra + rb
    b = x @ v
    if b >= 0:
        return None
    c = x @ x - R**2
    if c <= 0:
        return 0.0
    a = v @ v
    disc = b**2 - a * c
    if disc < 0:
        return None
    t = c / (-b + math.sqrt(disc))
    if t <= dt:
        return float(t)
    return None
