"""Sends half a million values in one frame."""

from frames import *


def scale(values, factor):
    raw(wire.Kind.RESULT, b"l" + struct.pack("<I", 500_000) + b"N" * 500_000)
