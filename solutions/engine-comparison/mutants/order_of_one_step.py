"""Wrong: the order of the local error, one too high."""


def _order(engine, omega):
    def after(h, n):
        q, v = engine.run("spring", [1.0], [0.7 * omega], h, n, [0.0])
        return np.array([q[-1][0], v[-1][0] / omega])

    def gap(z):
        return np.linalg.norm(after(z / omega, 1) - after(z / omega / 2, 2))

    return round(math.log2(gap(0.1) / gap(0.05)))
