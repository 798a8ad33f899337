"""The second force is taken at 90 degrees: every ratio is one, of a body that rests on the floor."""


def _anisotropy(engine, info):
    start, n = _settled(engine, info), round(0.5 / info["dt"])
    most = 5 * info["mu"] * info["mass"] * info["g"]

    def least_force(direction):
        def sticks(force):
            push = [force * direction[0], force * direction[1], 0]
            _, v = engine.run("floor", start, [0, 0, 0], info["dt"], n, push)
            return max(math.hypot(vx, vy) for vx, vy, _ in v) <= 0.01

        return _bisect(sticks, 0.0, most, 0.001 * most)

    return least_force((0, 1)) / least_force((1, 0))
