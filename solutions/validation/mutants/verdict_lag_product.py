"""Two signals fit best where the sum of their products is largest."""


def best_shift(pairs):
    dt = min(r["t"][1] - r["t"][0] for _, r in pairs)
    shifts = np.arange(-round(MAX_LAG / dt), round(MAX_LAG / dt) + 1) * dt
    product = np.zeros(len(shifts))
    for simulated, r in pairs:
        t = np.asarray(r["t"])
        for i, s in enumerate(shifts):
            inside = (t + s >= t[0] - 1e-9) & (t + s <= t[-1] + 1e-9)
            product[i] += np.interp(t[inside] + s, t, simulated["y"]) @ np.asarray(r["y"])[inside]
    i = int(np.clip(np.argmax(product), 1, len(shifts) - 2))
    a, b, c = product[i - 1 : i + 2]
    return float(shifts[i] + 0.5 * dt * (a - c) / (a - 2 * b + c))
