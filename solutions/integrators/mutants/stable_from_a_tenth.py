"""The search begins at h omega = 0.1, twice as far as it should."""


def max_stable_step(step, omega):
    def stable(z):
        columns = [
            step(lambda t, q, v: -(omega**2) * q, 0.0, np.array([a]), np.array([b * omega]), z / omega)
            for a, b in ((1.0, 0.0), (0.0, 1.0))
        ]
        matrix = [[c[0][0] for c in columns], [c[1][0] / omega for c in columns]]
        return max(abs(np.linalg.eigvals(matrix))) <= 1 + 1e-8

    if not stable(0.1):
        return 0.0
    low, high = 0.1, 0.15
    while stable(high):
        low, high = high, high + 0.05
        if low >= 10.0:
            return math.inf
    while high - low > 1e-6:
        middle = (low + high) / 2
        low, high = (middle, high) if stable(middle) else (low, middle)
    return low / omega
