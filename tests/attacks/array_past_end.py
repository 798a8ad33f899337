"""Sends an array longer than its frame."""

from frames import *


def scale(values, factor):
    raw(wire.Kind.RESULT, b"v" + struct.pack("<I", 1 << 20) + b"12345678")
