"""The best shift is a whole number of samples."""


def best_shift(pairs):
    dt = min(r["t"][1] - r["t"][0] for _, r in pairs)
    shifts = np.arange(-round(MAX_LAG / dt), round(MAX_LAG / dt) + 1) * dt
    return float(shifts[np.argmin(misfit(pairs, shifts))])
