"""Raises an exception whose class lies about its name and its line of descent."""

class Meta(type):
    @property
    def __name__(cls):
        raise SystemExit

    def __instancecheck__(cls, other):
        return True

    def mro(cls):
        return [cls, ValueError, Exception, BaseException, object]


class Hostile(ValueError, metaclass=Meta):
    pass


def scale(values, factor):
    raise Hostile


def draw(rng, n):
    raise type("E" * 100_000, (Exception,), {})
