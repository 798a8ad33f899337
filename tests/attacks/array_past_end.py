"""Sends an array longer than its frame."""

import gc
import struct
from course_worker.isolation.inside import wire

worker = next(thing for thing in gc.get_objects() if type(thing).__name__ == "Worker")
sock = worker._sock


def raw(kind, body, length=None):
    sock.sendall(struct.pack("<IB", len(body) + 1 if length is None else length, kind) + body)


def scale(values, factor):
    raw(wire.Kind.RESULT, b"v" + struct.pack("<I", 1 << 20) + b"12345678")
