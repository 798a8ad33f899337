"""Sends text that takes four times its size once it is decoded."""

import gc
import struct
from course_worker.isolation.inside import wire

worker = next(thing for thing in gc.get_objects() if type(thing).__name__ == "Worker")
sock = worker._sock


def raw(kind, body, length=None):
    sock.sendall(struct.pack("<IB", len(body) + 1 if length is None else length, kind) + body)


def scale(values, factor):
    text = "\U0001f600".encode() + b"a" * (60 << 20)
    raw(wire.Kind.RESULT, b"s" + struct.pack("<I", len(text)) + text)
