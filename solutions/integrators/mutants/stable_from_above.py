"""Searches downwards, and stops in a stable range beyond an unstable one."""


def max_stable_step(step, omega):
    def radius(z):
        columns = [
            step(lambda t, q, v: -(omega**2) * q, 0.0, np.array([a]), np.array([b * omega]), z / omega)
            for a, b in ((1.0, 0.0), (0.0, 1.0))
        ]
        return max(abs(np.linalg.eigvals([[c[0][0] for c in columns], [c[1][0] / omega for c in columns]])))

    z = 10.0
    if radius(z) <= 1 + 1e-8:
        return math.inf
    while z > 0.05 and radius(z) > 1 + 1e-8:
        z *= 0.996
    return z / omega if z > 0.05 else 0.0
