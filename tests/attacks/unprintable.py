"""Raises exceptions that raise when they are printed."""

class Unprintable(Exception):
    def __str__(self):
        raise self

    __repr__ = __str__


def scale(values, factor):
    raise Unprintable


def draw(rng, n):
    raise ExceptionGroup("group", [Unprintable(), ExceptionGroup("inner", [Unprintable()])])
