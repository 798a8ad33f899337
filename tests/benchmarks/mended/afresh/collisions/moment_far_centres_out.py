"""An early exit compares the distance of the centres, not the gap, with |v| dt, so contacts of big spheres
late in dt are lost.
"""


def time_of_impact(xa, va, ra, xb, vb, rb, dt):
    x, v, R = xb - xa, vb - va, ra + rb
    d = np.linalg.norm(x)
    if x @ v >= 0:
        return None
    if d < R:
        return 0.0
    if d > np.linalg.norm(v) * dt:  # too far away to reach each other within dt
        return None
    c = d * d - R * R
    root = (x @ v) ** 2 - (v @ v) * c
    if root < 0:
        return None
    t = c / (-(x @ v) + math.sqrt(root))
    return t if t <= dt else None
