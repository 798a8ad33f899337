"""A matrix is large if its entries are."""


def _search(step, omega, ok, top=10.0, dz=0.05, low0=0.05):
    def accel(t, q, v):
        return -(omega**2) * q

    def M(z):
        h = z / omega
        a = step(accel, 0.0, np.ones(1), np.zeros(1), h)
        b = step(accel, 0.0, np.zeros(1), omega * np.ones(1), h)
        return np.array([[a[0][0], b[0][0]], [a[1][0] / omega, b[1][0] / omega]])

    if not ok(M(low0)):
        return 0.0
    low = low0
    while ok(M(low + dz)):
        low += dz
        if low >= top:
            return math.inf
    high = low + dz
    for _ in range(40):
        m = (low + high) / 2
        low, high = (m, high) if ok(M(m)) else (low, m)
    return low / omega


def max_stable_step(step, omega):
    return _search(step, omega, lambda M: abs(M).sum() <= 1 + 1e-8)
