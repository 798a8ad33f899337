"""Fills memory with Python objects inside a call."""

def scale(values, factor):
    hoard = []
    for _ in range(20):
        hoard.append(bytearray(b"x") * (128 << 20))
    return values
