"""Wrong: the ratio the wrong way, of differences that may be nothing at all."""


def _order(engine, omega):
    def end(n):
        q, v = engine.run("free", [1.0], [0.0], 1.3 / omega / n, n, [0.0])
        return np.array([q[-1][0], v[-1][0] / omega])

    return float(np.log2(np.linalg.norm(end(16) - end(32)) / np.linalg.norm(end(32) - end(64))))
