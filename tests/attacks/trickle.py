"""Sends its answer one byte at a time."""

import gc
import struct
from course_worker.isolation.inside import wire

worker = next(thing for thing in gc.get_objects() if type(thing).__name__ == "Worker")
sock = worker._sock


def raw(kind, body, length=None):
    sock.sendall(struct.pack("<IB", len(body) + 1 if length is None else length, kind) + body)


import time


def scale(values, factor):
    for byte in wire.Codec().encode(wire.Kind.RESULT, [0.5] * 5000):
        sock.sendall(bytes([byte]))
        time.sleep(0.01)
