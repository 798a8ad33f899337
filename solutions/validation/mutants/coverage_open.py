"""Inside means strictly inside."""


def coverage(y, lo, hi):
    return float(np.mean((lo < y) & (y < hi)))
