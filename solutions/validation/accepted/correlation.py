"""The lag by the correlation coefficient of the overlap, a mean over the runs, with a parabola."""


def best_shift(pairs):
    dt = min(r["t"][1] - r["t"][0] for _, r in pairs)
    shifts = dt * np.arange(-round(0.25 / dt), round(0.25 / dt) + 1)
    likeness = []
    for s in shifts:
        each = []
        for simulated, r in pairs:
            t = np.asarray(r["t"])
            inside = (t + s >= t[0] - 1e-9) & (t + s <= t[-1] + 1e-9)
            shifted = np.interp(t[inside] + s, t, simulated["y"])
            each.append(np.corrcoef(shifted, np.asarray(r["y"])[inside])[0, 1])
        likeness.append(np.mean(each))
    i = int(np.clip(np.argmax(likeness), 1, len(shifts) - 2))
    a, b, c = likeness[i - 1 : i + 2]
    return float(shifts[i] + 0.5 * dt * (a - c) / (a - 2 * b + c))
