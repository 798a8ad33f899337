"""If a step of 10/omega is stable, all are."""


def max_stable_step(step, omega):
    def radius(h):
        columns = []
        for q0, v0 in ((1.0, 0.0), (0.0, 1.0)):
            q, v = step(lambda t, x, w: -omega * omega * x, 0.0, np.array([q0]), np.array([v0 * omega]), h)
            columns.append([q[0], v[0] / omega])
        return max(abs(np.linalg.eigvals(np.array(columns).T)))

    lo, hi = 0.05 / omega, 10 / omega
    if radius(lo) > 1 + 1e-8:
        return 0.0
    if radius(hi) <= 1 + 1e-8:
        return math.inf
    for _ in range(60):
        mid = (lo + hi) / 2
        if radius(mid) > 1 + 1e-8:
            hi = mid
        else:
            lo = mid
    return lo
