"""Sends the largest frame there may be, of text."""

from frames import *


def scale(values, factor):
    raw(wire.Kind.RESULT, b"s" + struct.pack("<I", (64 << 20)) + b"a" * (64 << 20))
