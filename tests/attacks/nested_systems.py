"""Sends right-hand sides named by right-hand sides, a hundred thousand deep."""

from frames import *


def scale(values, factor):
    raw(wire.Kind.RESULT, b"p" * 100_000 + b"N")
