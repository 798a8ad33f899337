# The second column starts from v = 1 and not from v = omega.


def max_stable_step(step, omega):
    def accel(t, q, v):
        return -(omega**2) * q

    def stable(h):
        qa, va = step(accel, 0.0, np.array([1.0]), np.array([0.0]), h)
        qb, vb = step(accel, 0.0, np.array([0.0]), np.array([1.0]), h)
        matrix = np.array([[qa[0], qb[0]], [va[0] / omega, vb[0] / omega]])
        return max(abs(np.linalg.eigvals(matrix))) <= 1 + 1e-8

    if not stable(0.05 / omega):
        return 0.0
    low = 0.05 / omega
    while stable(low + 0.1 / omega):
        low += 0.1 / omega
        if low > 10 / omega:
            return math.inf
    high = low + 0.1 / omega
    for _ in range(40):
        middle = (low + high) / 2
        if stable(middle):
            low = middle
        else:
            high = middle
    return low
