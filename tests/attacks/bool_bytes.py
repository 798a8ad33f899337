"""Sends truth values that are neither true nor false."""

import gc
import struct
from course_worker.isolation.inside import wire

worker = next(thing for thing in gc.get_objects() if type(thing).__name__ == "Worker")
sock = worker._sock


def raw(kind, body, length=None):
    sock.sendall(struct.pack("<IB", len(body) + 1 if length is None else length, kind) + body)


def scale(values, factor):
    raw(wire.Kind.RESULT, b"a\x02\x01\x03\x00\x00\x00\x02\x7f\xff")
