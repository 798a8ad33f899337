"""Says again that it is ready, and loaded, and refused."""

from frames import *


def scale(values, factor):
    for kind in (wire.Kind.READY, wire.Kind.LOADED, wire.Kind.REFUSED):
        raw(kind, b"N")
