"""Returns a right-hand side with millions of parameters."""

from frames import *


def scale(values, factor):
    body = b"p" + b"s\x0a\x00\x00\x00LinearStep" + b"d\x04\x00\x00\x00"
    for name in (b"qq", b"qp", b"pq", b"pp"):
        body += b"\x02\x00\x00\x00" + name + b"v" + struct.pack("<I", 1 << 20) + b"\0" * (8 << 20)
    raw(wire.Kind.RESULT, body)
