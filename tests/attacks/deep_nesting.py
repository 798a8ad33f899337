"""Sends lists in lists, a hundred thousand deep."""

from frames import *


def scale(values, factor):
    raw(wire.Kind.RESULT, b"l\x01\x00\x00\x00" * 100_000 + b"N")
