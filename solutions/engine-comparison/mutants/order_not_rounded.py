"""Wrong: a slope instead of a whole number."""

_whole_order = _order


def _order(engine, omega):
    def end(n):
        q, v = engine.run("spring", [1.0], [0.7 * omega], 1.3 / omega / n, n, [0.0])
        return np.array([q[-1][0], v[-1][0] / omega])

    coarse, middle, fine = end(16), end(32), end(64)
    return math.log2(np.linalg.norm(coarse - middle) / np.linalg.norm(middle - fine))
