"""n, 2n and 4n steps of one size: the end is three different times."""


def _order(engine, omega):
    h = 0.05 / omega

    def end(n):
        q, v = engine.run("spring", [1.0], [0.7 * omega], h, n, [0.0])
        return np.array([q[-1][0], v[-1][0] / omega])

    y1, y2, y3 = end(20), end(40), end(80)
    return round(math.log2(np.linalg.norm(y1 - y2) / np.linalg.norm(y2 - y3)))
