"""Calls a function of the grader's for ever."""

import gc
import struct
from course_worker.isolation.inside import wire

worker = next(thing for thing in gc.get_objects() if type(thing).__name__ == "Worker")
sock = worker._sock


def raw(kind, body, length=None):
    sock.sendall(struct.pack("<IB", len(body) + 1 if length is None else length, kind) + body)


def sample(f, points):
    while True:
        try:
            f(1.0)
        except Exception:
            pass


scale = lambda values, factor: values
