"""Lags are milliseconds."""

_in_seconds = best_shift


def best_shift(pairs):
    return 1000 * _in_seconds(pairs)
