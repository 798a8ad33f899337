"""Wrong: leaps of 2.5/omega miss a range of unstable steps that is little wider than 1/omega."""


def _max_stable_z(engine, omega):
    def stable(z):
        return max(abs(np.linalg.eigvals(_spring_step(engine, omega, z)))) <= 1 + 1e-8

    low = 0.05
    if not stable(low):
        return 0.0
    while stable(low + 2.5):
        low += 2.5
        if low >= 10:
            return math.inf
    return _bisect(stable, low, low + 2.5, 0.002 * low)
