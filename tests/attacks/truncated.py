"""Sends half a frame and leaves."""

from frames import *
import os


def scale(values, factor):
    raw(wire.Kind.RESULT, b"l\x05\x00\x00\x00N", length=100)
    os._exit(0)
