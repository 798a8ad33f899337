"""Sends text that takes four times its size once it is decoded."""

from frames import *


def scale(values, factor):
    text = "\U0001f600".encode() + b"a" * (60 << 20)
    raw(wire.Kind.RESULT, b"s" + struct.pack("<I", len(text)) + text)
