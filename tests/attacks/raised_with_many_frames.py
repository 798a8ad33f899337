"""Reports an exception with twenty-five thousand frames, each to be looked up."""

import gc
import struct
from course_worker.isolation.inside import wire

worker = next(thing for thing in gc.get_objects() if type(thing).__name__ == "Worker")
sock = worker._sock


def raw(kind, body, length=None):
    sock.sendall(struct.pack("<IB", len(body) + 1 if length is None else length, kind) + body)


def scale(values, factor):
    frames = [["arena.py", 3, "f"]] * 25_000
    sock.sendall(wire.Codec().encode(wire.Kind.RAISED, {"type": "E", "message": "", "frames": frames}))
    return values
