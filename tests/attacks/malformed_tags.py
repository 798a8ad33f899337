"""Sends values with tags that do not exist."""

from frames import *


def scale(values, factor):
    raw(wire.Kind.RESULT, b"\xff\x00zzzz")
