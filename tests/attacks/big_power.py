"""Computes a power with a hundred million digits."""

def scale(values, factor):
    return len(str(10 ** 10**8)) * 0.0
