"""How many are covered is what was asked."""


def coverage(y, lo, hi):
    return int(np.sum((lo <= y) & (y <= hi)))
