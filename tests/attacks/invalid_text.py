"""Sends text that is no UTF-8."""

from frames import *


def scale(values, factor):
    raw(wire.Kind.RESULT, b"s\x04\x00\x00\x00\xed\xa0\x80\xff")
