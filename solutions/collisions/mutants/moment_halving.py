"""The time of contact is found by halving, and the halving stops early."""

_right = time_of_impact


def time_of_impact(xa, va, ra, xb, vb, rb, dt):
    if _right(xa, va, ra, xb, vb, rb, dt) is None:
        return None
    x, v = xb - xa, vb - va
    low, high = 0.0, min(dt, float(-(x @ v) / (v @ v)))
    for _ in range(10):
        middle = (low + high) / 2
        touch = np.linalg.norm(x + middle * v) <= ra + rb
        low, high = (low, middle) if touch else (middle, high)
    return low
