"""Bodies that overlap and move apart are reported as colliding."""

_right = time_of_impact


def time_of_impact(xa, va, ra, xb, vb, rb, dt):
    return 0.0 if np.linalg.norm(xb - xa) <= ra + rb else _right(xa, va, ra, xb, vb, rb, dt)
