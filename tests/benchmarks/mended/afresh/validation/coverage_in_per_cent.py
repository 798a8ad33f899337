"""A coverage of 95 is 95 %."""


def coverage(y, lo, hi):
    inside = (np.asarray(lo) <= y) & (y <= np.asarray(hi))
    return 100.0 * float(np.mean(inside))
