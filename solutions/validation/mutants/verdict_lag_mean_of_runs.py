"""The lag of all runs is the mean of their lags."""

_shift = best_shift


def best_shift(pairs):
    counts = [len(r["t"]) for _, r in pairs]
    return float(np.average([_shift([pair]) for pair in pairs], weights=counts))
