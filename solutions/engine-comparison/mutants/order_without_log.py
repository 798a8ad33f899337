"""Wrong: the ratio of the differences is the order."""


def _order(engine, omega):
    def end(n):
        q, v = engine.run("spring", [1.0], [0.7 * omega], 1.3 / omega / n, n, [0.0])
        return np.array([q[-1][0], v[-1][0] / omega])

    return round(np.linalg.norm(end(64) - end(128)) / np.linalg.norm(end(128) - end(256)))
