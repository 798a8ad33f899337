"""The gap is divided by the relative speed, whatever its direction."""


def time_of_impact(xa, va, ra, xb, vb, rb, dt):
    x, v = xb - xa, vb - va
    if x @ v >= 0:
        return None
    t = max(np.linalg.norm(x) - ra - rb, 0.0) / np.linalg.norm(v)
    return float(t) if t <= dt else None
