"""Time of impact from numpy's roots of the quadratic, keeping the real ones within the step."""


def time_of_impact(xa, va, ra, xb, vb, rb, dt):
    x, v = np.subtract(xb, xa), np.subtract(vb, va)
    if np.dot(x, v) >= 0.0:
        return None
    if np.linalg.norm(x) <= ra + rb:
        return 0.0
    # In units of the diameter and of the time to cover it, so that no coefficient is tiny.
    unit = (ra + rb) / np.linalg.norm(v)
    x, v = x / (ra + rb), v * unit / (ra + rb)
    roots = np.roots([v @ v, 2 * x @ v, x @ x - 1.0])
    times = [unit * root.real for root in roots if root.imag == 0]
    first = min(times, default=math.inf)
    return np.float64(first) if first <= dt else None
