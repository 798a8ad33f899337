"""Sends bytes, which only a grader may send."""

from frames import *


def scale(values, factor):
    raw(wire.Kind.RESULT, b"y\x03\x00\x00\x00abc")


def draw(rng, n):
    raw(wire.Kind.RESULT, b"g" + b"\0" * 8)
