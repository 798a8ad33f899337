"""Says things in an exception that a terminal obeys."""

class Oops(Exception):
    pass


Oops.__name__ = "\x1b[2J\x9b31mOops\u202e"


def scale(values, factor):
    print("\x1b]0;owned\x07\x1b[1A\r100/100")
    raise Oops("\x1b[2J\x1b[1;1H\x08\x08 PASSED \u202e \x9b0m")


def double(x):
    return "\x1b[2J text"


def draw(rng, n):
    return {"\x1b[2J": "\x1b[3J"}
