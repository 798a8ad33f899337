"""Only lo and hi relative to y matter, so they may be overwritten."""


def coverage(y, lo, hi):
    lo -= y
    hi -= y
    return float(np.mean((lo <= 0) & (hi >= 0)))
