"""The step grows by six per cent, which is too much where it is long."""


def max_stable_step(step, omega):
    def stable(z):
        columns = [
            step(lambda t, q, v: -(omega**2) * q, 0.0, np.array([a]), np.array([b * omega]), z / omega)
            for a, b in ((1.0, 0.0), (0.0, 1.0))
        ]
        matrix = [[c[0][0] for c in columns], [c[1][0] / omega for c in columns]]
        return max(abs(np.linalg.eigvals(matrix))) <= 1 + 1e-8

    low = 0.05
    for z in np.geomspace(0.05, 10.0, 92):
        if not stable(z):
            break
        low = z
    else:
        return math.inf
    high = z
    while high - low > 1e-6:
        middle = (low + high) / 2
        low, high = (middle, high) if stable(middle) else (low, middle)
    return low / omega if high > 0.05 else 0.0
