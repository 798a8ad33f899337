"""Wrong: all intervals get the mean width."""


def coverage(y, lo, hi):
    y, lo, hi = (np.asarray(x, dtype=float) for x in (y, lo, hi))
    return float(np.mean(np.abs(y - (lo + hi) / 2) <= np.mean(hi - lo) / 2))
