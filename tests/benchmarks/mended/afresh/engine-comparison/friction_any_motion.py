"""It slides as soon as it has moved at all."""


def _anisotropy(engine, info):
    start = _settled(engine, info)
    steps = round(0.5 / info["dt"])
    top = 5 * info["mu"] * info["mass"] * info["g"]

    def threshold(x, y):
        a, b = 0.0, top
        while b - a > 0.001 * top:
            f = (a + b) / 2
            q, _ = engine.run("floor", start, [0, 0, 0], info["dt"], steps, [f * x, f * y, 0])
            moved = math.hypot(q[-1][0] - q[0][0], q[-1][1] - q[0][1]) > 1e-9
            a, b = (a, f) if moved else (f, b)
        return (a + b) / 2

    return threshold(math.sqrt(0.5), math.sqrt(0.5)) / threshold(1.0, 0.0)
