"""F(0) over F(45)."""


def _anisotropy(engine, info):
    start, n = _settled(engine, info), round(0.5 / info["dt"])

    def force_for(direction):
        low, high = 0.0, 5 * info["mu"] * info["mass"] * info["g"]
        for _ in range(14):
            F = (low + high) / 2
            push = [F * direction[0], F * direction[1], 0.0]
            _, v = engine.run("floor", start, [0, 0, 0], info["dt"], n, push)
            if np.max(np.hypot(np.array(v)[:, 0], np.array(v)[:, 1])) > 0.01:
                high = F
            else:
                low = F
        return (low + high) / 2

    return force_for((1.0, 0.0)) / force_for((math.sqrt(0.5), math.sqrt(0.5)))
