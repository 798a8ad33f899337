"""Two spheres are taken to meet only if the path of one centre leads through the other sphere."""

_right = time_of_impact


def time_of_impact(xa, va, ra, xb, vb, rb, dt):
    x, v = xb - xa, vb - va
    if v @ v > 0:
        nearest = x - (x @ v) / (v @ v) * v
        if np.linalg.norm(nearest) > max(ra, rb):
            return None
    return _right(xa, va, ra, xb, vb, rb, dt)
