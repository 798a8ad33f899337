"""alpha and coverage are the same number."""


def coverage(y, lo, hi):
    return float(np.mean((y < lo) | (hi < y)))
