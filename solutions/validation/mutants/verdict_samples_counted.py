"""The more samples, the surer the number: the errors of 3000 samples average out."""

_intervals = interval_of_each


def interval_of_each(pairs):
    y, sigma, measured = (np.concatenate(column) for column in zip(*map(columns, pairs)))
    e = y - measured
    intervals, bias = _intervals(pairs), float(np.mean(e))
    half = 1.96 * float(np.std(e)) / math.sqrt(len(e))
    return intervals | {"bias": (bias - half, bias + half)}
