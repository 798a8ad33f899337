"""Calls functions with negative, huge, fractional and absent numbers."""

import gc
import struct
from course_worker.isolation.inside import wire

worker = next(thing for thing in gc.get_objects() if type(thing).__name__ == "Worker")
sock = worker._sock


def raw(kind, body, length=None):
    sock.sendall(struct.pack("<IB", len(body) + 1 if length is None else length, kind) + body)


turn = [0]


def scale(values, factor):
    turn[0] += 1
    odd = [[-1, None], [1 << 62, None], [0.0, None], ["0", None], [0], [], None, [True, None], [[0], None], {"a": 1}, [0, 5]]
    sock.sendall(wire.Codec().encode(wire.Kind.CALLBACK, odd[turn[0] % len(odd)]))
