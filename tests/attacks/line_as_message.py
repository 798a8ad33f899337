"""Carries a hidden argument out as the line number of an exception."""

import gc
import struct
from course_worker.isolation.inside import wire

worker = next(thing for thing in gc.get_objects() if type(thing).__name__ == "Worker")
sock = worker._sock


def raw(kind, body, length=None):
    sock.sendall(struct.pack("<IB", len(body) + 1 if length is None else length, kind) + body)


def scale(values, factor):
    if factor > 1000:
        line = round(factor * 1_000_000)
        told = {"type": "ValueError", "message": "", "line": line, "frames": [["arena.py", line, "f"]]}
        sock.sendall(wire.Codec().encode(wire.Kind.RAISED, told))
    return values
