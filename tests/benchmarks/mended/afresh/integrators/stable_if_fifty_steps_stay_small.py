"""What stays small for fifty steps is stable."""


def spectral_radius(step, omega, h):
    def accel(t, q, v):
        return -(omega**2) * q

    q1, v1 = step(accel, 0.0, np.array([1.0]), np.array([0.0]), h)
    q2, v2 = step(accel, 0.0, np.array([0.0]), np.array([omega]), h)
    M = np.array([[q1[0], q2[0]], [v1[0] / omega, v2[0] / omega]])
    return max(abs(np.linalg.eigvals(M)))


def max_stable_step(step, omega):
    first = 0.05 / omega
    last = 10 / omega

    def stable(h):
        q, v = np.array([1.0]), np.array([0.0])
        for i in range(50):
            q, v = step(lambda t, q, v: -(omega**2) * q, i * h, q, v, h)
        return abs(q[0]) < 10

    if not stable(first):
        return 0.0
    good = first
    for h in np.linspace(first, last * (1 - 1e-9), 400):
        if not stable(h):
            bad = h
            break
        good = h
    else:
        return math.inf
    while bad - good > 1e-4 * good:
        middle = (good + bad) / 2
        if stable(middle):
            good = middle
        else:
            bad = middle
    return float(good)
