"""Sends an empty array whose dimensions multiply beyond any memory."""

from frames import *


def scale(values, factor):
    raw(wire.Kind.RESULT, b"a\x00\x08" + struct.pack("<8I", 0, *[0xFFFFFFFF] * 7))
