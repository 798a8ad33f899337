"""An interval includes its start and not its end, as range does."""


def coverage(y, lo, hi):
    return float(np.mean((lo <= y) & (y < hi)))
