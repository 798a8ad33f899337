"""The interval's half-width, twice, where its two ends belong."""

_bounds = identify


def identify(t, u, y):
    return {k: [x, x - low, high - x] for k, (x, low, high) in _bounds(t, u, y).items()}
