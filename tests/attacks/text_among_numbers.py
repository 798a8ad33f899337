"""Returns one long text among many numbers, which an array would repeat for each."""

import gc
import struct
from course_worker.isolation.inside import wire

worker = next(thing for thing in gc.get_objects() if type(thing).__name__ == "Worker")
sock = worker._sock


def raw(kind, body, length=None):
    sock.sendall(struct.pack("<IB", len(body) + 1 if length is None else length, kind) + body)


def scale(values, factor):
    return ["x" * 500_000, *[1.0] * 50_000]


def double(x):
    return [["y" * 400_000] + [0.0] * 20_000, [1.0] * 20_001]


draw = lambda rng, n: scale(0, 0)
