# Values on the ends do not count.


def coverage(y, lo, hi):
    y = np.asarray(y)
    return float(np.mean((y > lo) & (y < hi)))
