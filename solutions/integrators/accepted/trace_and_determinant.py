"""Stability from trace and determinant (Jury's conditions), walking up in steps of two per cent."""


def max_stable_step(step, omega):
    def accel(t, q, v):
        return [-omega * omega * x for x in q]

    def radius(h):
        a, c = step(accel, 0.0, np.array([1.0]), np.array([0.0]), h)
        b, d = step(accel, 0.0, np.array([0.0]), np.array([1.0]), h)
        half_trace = float(a[0] + d[0]) / 2
        determinant = float(a[0] * d[0] - b[0] * c[0])
        inside = half_trace**2 - determinant
        return math.sqrt(determinant) if inside < 0 else abs(half_trace) + math.sqrt(inside)

    h = 0.05 / omega
    if radius(h) > 1 + 1e-8:
        return 0
    while h * omega < 10:
        if radius(1.02 * h) > 1 + 1e-8:
            low, high = h, 1.02 * h
            while high - low > 1e-5 * low:
                middle = (low + high) / 2
                low, high = (middle, high) if radius(middle) <= 1 + 1e-8 else (low, middle)
            return low
        h *= 1.02
    return float("inf")
