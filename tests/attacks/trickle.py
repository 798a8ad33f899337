"""Sends its answer one byte at a time."""

from frames import *
import time


def scale(values, factor):
    for byte in wire.Codec().encode(wire.Kind.RESULT, [0.5] * 5000):
        sock.sendall(bytes([byte]))
        time.sleep(0.01)
