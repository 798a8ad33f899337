"""The step is cut into a thousand parts, and the first overlap counts."""

_right = time_of_impact


def time_of_impact(xa, va, ra, xb, vb, rb, dt):
    x, v = xb - xa, vb - va
    if x @ v >= 0:
        return None
    t = np.linspace(0.0, dt, 1001)
    hits = np.flatnonzero(np.linalg.norm(x + t[:, None] * v, axis=1) <= ra + rb)
    return float(t[hits[0]]) if len(hits) else None
