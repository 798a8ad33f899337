"""Closes one direction of its connection and waits."""

import gc
import struct
from course_worker.isolation.inside import wire

worker = next(thing for thing in gc.get_objects() if type(thing).__name__ == "Worker")
sock = worker._sock


def raw(kind, body, length=None):
    sock.sendall(struct.pack("<IB", len(body) + 1 if length is None else length, kind) + body)


import socket
import time


def scale(values, factor):
    try:
        sock.shutdown(socket.SHUT_WR)
    except OSError:
        pass
    time.sleep(30)
