"""Wrong: the walk takes strides of 2/omega, more than an unstable range is wide."""


def _max_stable_z(engine, omega):
    def stable(z):
        return max(abs(np.linalg.eigvals(_spring_step(engine, omega, z)))) <= 1 + 1e-8

    low = 0.05
    if not stable(low):
        return 0.0
    while stable(low + 1.99):
        low += 1.99
        if low >= 10:
            return math.inf
    return _bisect(stable, low, low + 1.99, 0.004 * low)
