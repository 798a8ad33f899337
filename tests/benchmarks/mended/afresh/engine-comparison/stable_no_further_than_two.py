"""Nothing is stable beyond 2/omega, so the search ends there with infinity."""


def _max_stable_z(engine, omega):
    def grows(z):
        m = _spring_step(engine, omega, z)
        return max(abs(np.linalg.eigvals(m))) > 1 + 1e-8

    if grows(0.05):
        return 0.0
    z = 0.05
    while z < 2.0:
        if grows(z + 0.02):
            return z
        z += 0.02
    return math.inf
