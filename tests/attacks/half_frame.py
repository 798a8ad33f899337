"""Sends half a frame and waits."""

from frames import *
import time


def scale(values, factor):
    raw(wire.Kind.RESULT, b"l\x05\x00\x00\x00N", length=100)
    time.sleep(30)
