"""Wrong: the search comes from above and stops at a later stable range."""


def _max_stable_z(engine, omega):
    def stable(z):
        return max(abs(np.linalg.eigvals(_spring_step(engine, omega, z)))) <= 1 + 1e-8

    if not stable(0.05):
        return 0.0
    high = 10.0
    if stable(high):
        return math.inf
    while not stable(high - 0.1):
        high -= 0.1
    return _bisect(stable, high - 0.1, high, 0.01)
