"""Calls a function with arrays that the grader would have to keep."""

import gc
import struct
from course_worker.isolation.inside import wire

worker = next(thing for thing in gc.get_objects() if type(thing).__name__ == "Worker")
sock = worker._sock


def raw(kind, body, length=None):
    sock.sendall(struct.pack("<IB", len(body) + 1 if length is None else length, kind) + body)


def sample(f, points):
    hoard = np.zeros(2 << 20)
    while True:
        try:
            f(hoard)
        except Exception:
            pass
