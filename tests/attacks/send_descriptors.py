"""Sends open files along with its answer."""

import gc
import struct
from course_worker.isolation.inside import wire

worker = next(thing for thing in gc.get_objects() if type(thing).__name__ == "Worker")
sock = worker._sock


def raw(kind, body, length=None):
    sock.sendall(struct.pack("<IB", len(body) + 1 if length is None else length, kind) + body)


import os
import socket

read, write = os.pipe()


def scale(values, factor):
    for _ in range(20):
        try:
            socket.send_fds(sock, [wire.Codec().encode(wire.Kind.RESULT, True)], [read, write, 1, 2])
        except OSError:
            pass
    return values
