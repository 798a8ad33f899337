"""Raises from a chain of ten thousand causes and nine hundred frames."""

def fall(n):
    if n == 0:
        raise ValueError("deep")
    fall(n - 1)


def scale(values, factor):
    error = ValueError("first")
    for k in range(10_000):
        following = ValueError(str(k))
        following.__cause__ = error
        error = following
    try:
        fall(900)
    except ValueError as deep:
        raise error from deep
