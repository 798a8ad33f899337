"""A relative speed below 1 cm/s counts as none."""

_right = time_of_impact


def time_of_impact(xa, va, ra, xb, vb, rb, dt):
    if np.linalg.norm(np.subtract(vb, va)) < 0.01 and np.linalg.norm(np.subtract(xb, xa)) > ra + rb:
        return None
    return _right(xa, va, ra, xb, vb, rb, dt)
