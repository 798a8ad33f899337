"""Raises an exception with a message of 50 MB."""

def scale(values, factor):
    raise ValueError("m" * (50 << 20))
