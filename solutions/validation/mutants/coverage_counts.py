"""The task asks how many values are covered."""


def coverage(y, lo, hi):
    return int(np.sum((lo <= y) & (y <= hi)))
