# One bisection over the whole range misses what is unstable in between.


def _max_stable_z(engine, omega):
    def stable(z):
        return max(abs(np.linalg.eigvals(_spring_step(engine, omega, z)))) <= 1 + 1e-8

    if not stable(0.05):
        return 0.0
    if stable(10.0):
        return math.inf
    return _bisect(stable, 0.05, 10.0, 0.001)
