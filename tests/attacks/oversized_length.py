"""Announces a frame of 4 GB."""

from frames import *


def scale(values, factor):
    raw(wire.Kind.RESULT, b"x" * 1000, length=0xFFFFFFFF)
