"""Wrong: steps so small that the differences are nothing but rounding."""


def _order(engine, omega):
    def end(n):
        q, v = engine.run("spring", [1.0], [0.7 * omega], 0.05 / omega / n, n, [0.0])
        return np.array([q[-1][0], v[-1][0] / omega])

    coarse, middle, fine = end(400), end(800), end(1600)
    gap = max(np.linalg.norm(middle - fine), 1e-16)
    return min(round(math.log2(max(np.linalg.norm(coarse - middle), 1e-16) / gap)), 3)
