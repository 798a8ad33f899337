"""Wrong: half the width and the middle are rounded."""


def coverage(y, lo, hi):
    y, lo, hi = (np.asarray(x, dtype=float) for x in (y, lo, hi))
    return float(np.mean(np.abs(y - (lo + hi) / 2) <= (hi - lo) / 2))
