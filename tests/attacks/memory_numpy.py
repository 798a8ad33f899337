"""Fills memory with arrays inside a call."""

def scale(values, factor):
    return [np.ones(32 << 20) for _ in range(64)][0]
