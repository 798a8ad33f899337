"""Claims while it is loaded that the lockdown failed, to look like the grader's fault."""

import gc
import struct
from course_worker.isolation.inside import wire

worker = next(thing for thing in gc.get_objects() if type(thing).__name__ == "Worker")
sock = worker._sock


def raw(kind, body, length=None):
    sock.sendall(struct.pack("<IB", len(body) + 1 if length is None else length, kind) + body)


sock.sendall(wire.Codec().encode(wire.Kind.REFUSED, {"stage": "lockdown", "message": "no Landlock"}))
