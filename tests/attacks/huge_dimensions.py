"""Sends an empty array whose dimensions multiply beyond any memory."""

import gc
import struct
from course_worker.isolation.inside import wire

worker = next(thing for thing in gc.get_objects() if type(thing).__name__ == "Worker")
sock = worker._sock


def raw(kind, body, length=None):
    sock.sendall(struct.pack("<IB", len(body) + 1 if length is None else length, kind) + body)


def scale(values, factor):
    raw(wire.Kind.RESULT, b"a\x00\x08" + struct.pack("<8I", 0, *[0xFFFFFFFF] * 7))
