"""Forges an answer from atexit, a finaliser and a weak reference."""

import atexit
import gc
import weakref

from course_worker.isolation.inside import wire


def forge(*_):
    for thing in gc.get_objects():
        if type(thing).__name__ == "Worker":
            thing._sock.sendall(wire.Codec().encode(wire.Kind.RESULT, True))


class Finalised:
    def __del__(self):
        forge()


atexit.register(forge)
kept = weakref.finalize(Finalised, forge)


def scale(values, factor):
    Finalised()
    return values
