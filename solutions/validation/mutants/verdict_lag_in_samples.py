"""A lag is a number of samples."""

_shift = best_shift


def best_shift(pairs):
    return _shift(pairs) / min(r["t"][1] - r["t"][0] for _, r in pairs)
