"""95 % is ninety-five."""


def coverage(y, lo, hi):
    return 100 * float(np.mean((lo <= y) & (y <= hi)))
