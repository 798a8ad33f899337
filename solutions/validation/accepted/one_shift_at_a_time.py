"""One shift after the other is tried, on the samples that overlap: what most people write."""


def misfit(pairs, shifts):
    return np.array([_misfit_of_one(pairs, s) for s in shifts])


def _misfit_of_one(pairs, s):
    e = []
    for simulated, r in pairs:
        t = np.asarray(r["t"])
        inside = (t + s >= t[0] - 1e-9) & (t + s <= t[-1] + 1e-9)
        e.append(np.interp(t[inside] + s, t, simulated["y"]) - np.asarray(r["y"])[inside])
    return np.mean(np.concatenate(e) ** 2)
