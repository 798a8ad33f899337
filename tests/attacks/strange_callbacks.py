"""Calls functions with negative, huge, fractional and absent numbers."""

from frames import *


turn = [0]


def scale(values, factor):
    turn[0] += 1
    odd = [[-1, None], [1 << 62, None], [0.0, None], ["0", None], [0], [], None, [True, None], [[0], None], {"a": 1}, [0, 5]]
    sock.sendall(wire.Codec().encode(wire.Kind.CALLBACK, odd[turn[0] % len(odd)]))
