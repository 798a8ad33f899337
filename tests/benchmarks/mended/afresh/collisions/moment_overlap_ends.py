"""Spheres that overlap and approach get the positive root, the time at which they leave each other, instead
of 0.0.
"""


def time_of_impact(xa, va, ra, xb, vb, rb, dt):
    x, v, R = xb - xa, vb - va, ra + rb
    if x @ v >= 0:
        return None
    a, b, c = v @ v, 2 * (x @ v), x @ x - R**2
    disc = b * b - 4 * a * c
    if disc < 0:
        return None
    t = min(r for r in ((-b - math.sqrt(disc)) / (2 * a), (-b + math.sqrt(disc)) / (2 * a)) if r >= 0)
    return t if t <= dt else None
