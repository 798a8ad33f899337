"""Fills memory with arrays inside a call."""

def scale(values, factor):
    return [np.empty(32 << 20) for _ in range(64)][0]
