"""A simulation that must be moved forward in time is early."""

_shift = best_shift


def best_shift(pairs):
    return -_shift(pairs)
