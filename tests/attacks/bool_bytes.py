"""Sends truth values that are neither true nor false."""

from frames import *


def scale(values, factor):
    raw(wire.Kind.RESULT, b"a\x02\x01\x03\x00\x00\x00\x02\x7f\xff")
