"""The start state is (1, 1) instead of (1, 0) in the first column."""


def max_stable_step(step, omega):
    def accel(t, q, v):
        return -(omega**2) * q

    def radius(h):
        qa, va = step(accel, 0.0, np.array([1.0]), np.array([1.0]), h)
        qb, vb = step(accel, 0.0, np.array([0.0]), np.array([omega]), h)
        M = np.array([[qa[0], qb[0]], [va[0] / omega, vb[0] / omega]])
        return np.max(np.abs(np.linalg.eigvals(M)))

    def stable(z):
        return radius(z / omega) <= 1 + 1e-8

    if not stable(0.05):
        return 0.0
    z = 0.05
    while stable(z + 0.02):
        z += 0.02
        if z >= 10:
            return math.inf
    low, high = z, z + 0.02
    while high - low > 1e-5:
        middle = (low + high) / 2
        if stable(middle):
            low = middle
        else:
            high = middle
    return low / omega
