"""Wrong: the natural logarithm."""


def _order(engine, omega):
    def end(n):
        q, v = engine.run("spring", [1.0], [0.7 * omega], 1.3 / omega / n, n, [0.0])
        return np.array([q[-1][0], v[-1][0] / omega])

    return round(math.log(np.linalg.norm(end(16) - end(32)) / np.linalg.norm(end(32) - end(64))))
