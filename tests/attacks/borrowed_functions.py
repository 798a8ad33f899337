"""Returns the grader's own functions, and some it was never given."""

from frames import *


def compose(f, g, x):
    raw(wire.Kind.RESULT, b"c\x00\x00\x00\x00")


def scale(values, factor):
    raw(wire.Kind.RESULT, b"c\xff\xff\x00\x00")


def sample(f, points):
    raw(wire.Kind.CALLBACK, wire.Codec().encode(0, [0, {"self": 1, "x": 2, "__class__": 3}, 1.0])[5:])
    raw(wire.Kind.RESULT, b"c\x00\x00\x00\x00")
