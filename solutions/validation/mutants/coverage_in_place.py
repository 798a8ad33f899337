"""lo and hi, measured from y, are all that counts."""


def coverage(y, lo, hi):
    lo -= y
    hi -= y
    return float(np.mean((lo <= 0) & (hi >= 0)))
