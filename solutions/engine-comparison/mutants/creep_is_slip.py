"""Wrong: any motion at all taken for sliding."""


def _anisotropy(engine, info):
    start, n = _settled(engine, info), round(0.5 / info["dt"])
    most = 5 * info["mu"] * info["mass"] * info["g"]

    def least_force(angle):
        def sticks(force):
            push = [force * math.cos(angle), force * math.sin(angle), 0]
            _, v = engine.run("floor", start, [0, 0, 0], info["dt"], n, push)
            return max(math.hypot(vx, vy) for vx, vy, _ in v) <= 1e-6

        return _bisect(sticks, 0.0, most, 1e-7 * most)

    return least_force(math.pi / 4) / least_force(0.0)
