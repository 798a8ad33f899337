"""Friction is against the command: sign(u)."""


def identify(t, u, y):
    def fit(u, y, keep, tau, late, base):
        columns = np.stack([delayed(motor_impulse(u, tau), late), *base], axis=1)
        X, Y = in_blocks(columns)[keep], in_blocks(y)[keep]
        X, Y = X.reshape(-1, 3), Y.reshape(-1)
        theta = np.linalg.lstsq(X, Y, rcond=None)[0]
        return float(np.sum((Y - X @ theta) ** 2)), theta

    def search(u, y, keep, base, grid):
        best = None
        for tau, late in grid:
            left, theta = fit(u, y, keep, tau, late, base)
            if best is None or left < best[0]:
                best = (left, tau, late, theta)
        _, tau, late, theta = best
        m = 1 / theta[0]
        return {
            "m": m,
            "b": -theta[1] * m,
            "Fc": -theta[2] * m,
            "tau": tau,
            "latency": late,
            "lag": tau + late,
        }

    u, y = np.asarray(u, dtype=float), np.asarray(y, dtype=float)
    base = [cumulative(y), cumulative(np.sign(u))]
    blocks = len(y) // 100
    every = np.arange(blocks)
    rough = [(a, b) for a in np.arange(0.02, 0.16, 0.02) for b in np.arange(0.02, 0.21, 0.02)]
    p = search(u, y, every, base, rough)
    near = [
        (max(p["tau"] + a, 0.01), max(p["latency"] + b, 0.0))
        for a in (-0.01, 0.0, 0.01)
        for b in (-0.01, -0.005, 0.0, 0.005, 0.01)
    ]
    p = search(u, y, every, base, near)
    few = [(p["tau"], p["latency"] + b) for b in (-0.004, 0.0, 0.004)]
    left_out = [search(u, y, np.delete(every, i), base, few) for i in range(blocks)]
    result = {}
    for name, value in p.items():
        x = np.array([one[name] for one in left_out])
        half = 2.1 * math.sqrt((blocks - 1) / blocks * np.sum((x - x.mean()) ** 2)) + 0.02 * abs(value)
        result[name] = [value, value - half, value + half]
    return result
