"""The lag by correlation: the squares of both signals minus twice their product, over all runs."""


def best_shift(pairs):
    dt = min(r["t"][1] - r["t"][0] for _, r in pairs)
    shifts = dt * np.arange(-round(0.25 / dt), round(0.25 / dt) + 1)
    apart = np.zeros(len(shifts))
    count = np.zeros(len(shifts))
    for simulated, r in pairs:
        t, y = np.asarray(r["t"]), np.asarray(r["y"])
        for i, s in enumerate(shifts):
            inside = (t + s >= t[0] - 1e-9) & (t + s <= t[-1] + 1e-9)
            shifted, here = np.interp(t[inside] + s, t, simulated["y"]), y[inside]
            apart[i] += shifted @ shifted + here @ here - 2 * (shifted @ here)
            count[i] += len(here)
    cost = apart / count
    i = int(np.clip(np.argmin(cost), 1, len(shifts) - 2))
    a, b, c = cost[i - 1 : i + 2]
    return float(shifts[i] + 0.5 * dt * (a - c) / (a - 2 * b + c))
