"""All runs have the step of the first: shifts are whole samples, and a parabola finds the rest."""


def best_shift(pairs):
    dt = pairs[0][1]["t"][1] - pairs[0][1]["t"][0]
    most = round(MAX_LAG / dt)
    cost = np.array([
        np.mean(np.concatenate([
            (np.roll(np.asarray(s["y"]), -k) - np.asarray(r["y"]))[max(0, -k) : len(r["y"]) - max(0, k)]
            for s, r in pairs
        ]) ** 2)
        for k in range(-most, most + 1)
    ])  # fmt: skip
    i = int(np.clip(np.argmin(cost), 1, len(cost) - 2))
    a, b, c = cost[i - 1 : i + 2]
    return float(dt * (i - most + 0.5 * (a - c) / (a - 2 * b + c)))
