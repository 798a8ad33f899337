"""95 % is 1.96 standard errors."""

_intervals = interval_of_each


def interval_of_each(pairs):
    t, numbers = T95[len(pairs) - 2], measures(pairs)
    halves = {key: 1.96 / t * (hi - lo) / 2 for key, (lo, hi) in _intervals(pairs).items()}
    return {key: (value - halves[key], value + halves[key]) for key, value in numbers.items()}
