# Compared with the exact spring.


def _order(engine, omega):
    exact = np.array([math.cos(1.3) + 0.7 * math.sin(1.3), 0.7 * math.cos(1.3) - math.sin(1.3)])

    def error(n):
        q, v = engine.run("spring", [1.0], [0.7 * omega], 1.3 / omega / n, n, [0.0])
        return np.linalg.norm(np.array([q[-1][0], v[-1][0] / omega]) - exact)

    return round(math.log2(error(32) / error(64)))
