"""Sends frames of its own making; put where an attack says ``from frames import *``."""

import gc
import struct
from course_worker.isolation.inside import wire

worker = next(thing for thing in gc.get_objects() if type(thing).__name__ == "Worker")
sock = worker._sock


def raw(kind, body, length=None):
    sock.sendall(struct.pack("<IB", len(body) + 1 if length is None else length, kind) + body)
