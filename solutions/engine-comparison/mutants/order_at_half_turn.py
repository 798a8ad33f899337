"""Wrong: the order where the first-order error vanishes."""


def _order(engine, omega):
    def end(n):
        q, _ = engine.run("spring", [1.0], [0.0], math.pi / omega / n, n, [0.0])
        return q[-1][0]

    return round(math.log2(abs(end(64) - end(128)) / abs(end(128) - end(256))))
