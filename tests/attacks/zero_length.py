"""Announces a frame of no bytes."""

from frames import *


def scale(values, factor):
    sock.sendall(b"\0\0\0\0" + bytes([wire.Kind.RESULT]) * 60)
