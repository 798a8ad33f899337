"""Reports an exception with twenty-five thousand frames, each to be looked up."""

from frames import *


def scale(values, factor):
    frames = [["arena.py", 3, "f"]] * 25_000
    sock.sendall(wire.Codec().encode(wire.Kind.RAISED, {"type": "E", "message": "", "frames": frames}))
    return values
