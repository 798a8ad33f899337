"""The best shift has the least sum of squares, however few samples overlap."""


def misfit(pairs, s):
    total = 0.0
    for simulated, r in pairs:
        t = np.asarray(r["t"])
        inside = (t + s >= t[0] - 1e-9) & (t + s <= t[-1] + 1e-9)
        e = np.interp(t[inside] + s, t, simulated["y"]) - np.asarray(r["y"])[inside]
        total += np.sum(e**2)
    return total
