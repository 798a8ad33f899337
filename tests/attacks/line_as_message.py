"""Carries a hidden argument out as the line number of an exception."""

from frames import *


def scale(values, factor):
    if factor > 1000:
        line = round(factor * 1_000_000)
        told = {"type": "ValueError", "message": "", "line": line, "frames": [["arena.py", line, "f"]]}
        sock.sendall(wire.Codec().encode(wire.Kind.RAISED, told))
    return values
