"""Frames over the pipes between processes of ours: a 4-byte little-endian length, then msgpack."""

from __future__ import annotations

import struct
from typing import IO, Any

import msgspec

__all__ = ["read_frame", "write_frame"]

_LENGTH = struct.Struct("<I")


def read_frame(source: IO[bytes], most: int | None = None) -> bytes | None:
    """The next frame's content; None at the end of the stream, or if it is longer than ``most`` bytes."""
    header = source.read(_LENGTH.size)
    if len(header) < _LENGTH.size:
        return None
    size = _LENGTH.unpack(header)[0]
    if most is not None and size > most:
        return None
    body = source.read(size)
    return body if len(body) == size else None


def write_frame(sink: IO[bytes], message: Any) -> None:
    """Write one message and flush it."""
    body = msgspec.msgpack.encode(message)
    sink.write(_LENGTH.pack(len(body)) + body)
    sink.flush()
