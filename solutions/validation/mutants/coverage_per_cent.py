"""95 % is written as 95."""


def coverage(y, lo, hi):
    return 100 * float(np.mean((lo <= y) & (y <= hi)))
