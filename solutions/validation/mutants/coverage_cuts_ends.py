"""The ends take the type of the values: of whole ones, fractions are cut off."""


def coverage(y, lo, hi):
    y = np.asarray(y)
    ends = np.empty((2, len(y)), dtype=y.dtype)
    ends[:] = lo, hi
    return float(np.mean((ends[0] <= y) & (y <= ends[1])))
