"""Never reads what the grader sends, while it keeps asking."""

import gc
import struct
from course_worker.isolation.inside import wire

worker = next(thing for thing in gc.get_objects() if type(thing).__name__ == "Worker")
sock = worker._sock


def raw(kind, body, length=None):
    sock.sendall(struct.pack("<IB", len(body) + 1 if length is None else length, kind) + body)


import time


def sample(f, points):
    frame = wire.Codec().encode(wire.Kind.CALLBACK, [0, None, 1.0])
    for _ in range(100_000):
        sock.sendall(frame)
    time.sleep(30)
