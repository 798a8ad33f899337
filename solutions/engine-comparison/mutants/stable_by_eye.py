"""Wrong: an engine that grows slowly gets a positive limit."""


def _max_stable_z(engine, omega):
    def stable(z):
        q, v = engine.run("spring", [1.0], [0.3 * omega], z / omega, 2000, [0.0])
        return max(abs(x[0]) for x in q) < 3

    low = 0.05
    while low < 10 and stable(low + 0.25):
        low += 0.25
    return math.inf if low >= 10 else _bisect(stable, low, low + 0.25, 0.004 * low)
