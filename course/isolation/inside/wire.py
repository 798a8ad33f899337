"""The bytes between a grader and the process that runs a stranger's code.

A frame is a 4-byte little-endian length, one byte that says what kind of message it is, and one value. A
value is one of None, bool, int64, float64, str, list, dict with str keys, an array of float64, int64, bool
or complex128, a right-hand side by name, a seed, or a callable by reference; nothing else can be said, so
nothing can be un-pickled. One tag byte opens each value::

    N  T  F      None, True, False            l  list    u32 count, values
    i  int64     8 bytes                      d  dict    u32 count, (u32 length, UTF-8) and value each
    f  float64   8 bytes                      a  array   dtype byte, ndim byte, u32 each, raw little-endian
    v  vector    u32 count, raw float64       c  callable held by the receiver     u32
    r  floats    u32 count, raw float64       w  callable held by the sender       u32
    s  str       u32 length, UTF-8            p  right-hand side: a str and a dict
    y  bytes     u32 length (grader to        g  random generator: its seed, int64
                 worker only)                 t  dicts with the same keys: u32 count of keys,
                                                 (u32 length, UTF-8) and a list of values each

A list of nothing but floats goes as ``r``, one of dicts with the same keys as ``t``; both arrive as lists.

This file and the three it imports run on both sides and are copied next to a stranger's code, so they import
the standard library and numpy and nothing of this course. Whatever arrives is a claim by an untrusted sender:
every length is checked before it is used, and the only exception that leaves these files is ``WireError``.
"""

from __future__ import annotations

import struct
from typing import Any

from .decoding import OTHER, Reader, quick
from .encoding import put
from .frames import (
    HEADER,
    LOOK,
    LOOKS,
    MAX_ARRAY_BYTES,
    MAX_DEPTH,
    MAX_DIMENSIONS,
    MAX_FRAME,
    MAX_VALUE_BYTES,
    MAX_VALUES,
    Kind,
    Names,
    Reference,
    Rhs,
    Seed,
    UnsupportedValueError,
    WireError,
    room_for,
)

__all__ = [
    "HEADER",
    "LOOK",
    "LOOKS",
    "MAX_ARRAY_BYTES",
    "MAX_DEPTH",
    "MAX_DIMENSIONS",
    "MAX_FRAME",
    "MAX_VALUES",
    "MAX_VALUE_BYTES",
    "Codec",
    "Kind",
    "Names",
    "Reference",
    "Rhs",
    "Seed",
    "UnsupportedValueError",
    "WireError",
    "room_for",
]


_NO_HEADER = bytes(HEADER.size)


class Codec:
    """Encodes and decodes frames for one side of one connection.

    Args:
        names: resolves callables, right-hand sides and seeds; None refuses them.
        accept_bytes: whether a bytes value may arrive (only a worker accepts it: the submission's files).
    """

    def __init__(self, names: Names | None = None, *, accept_bytes: bool = False) -> None:
        self._names = names
        self._accept_bytes = accept_bytes

    def encode(self, kind: int, value: Any) -> bytearray:
        """One frame.

        Raises:
            UnsupportedValueError: something in ``value`` cannot cross, or it is too large or too deep.
        """
        parts: list[bytes | memoryview] = [_NO_HEADER]
        arrays = put(value, parts, self._names, MAX_DEPTH)
        frame = bytearray().join(parts)
        size = len(frame) - HEADER.size
        if size - arrays > MAX_VALUE_BYTES or arrays > MAX_ARRAY_BYTES:
            raise UnsupportedValueError("a value that is too large (1 MB of plain values, 8 MB of arrays)")
        HEADER.pack_into(frame, 0, size + 1, kind)
        return frame

    def decode(self, body: bytes | memoryview) -> Any:
        """The value of a frame's body (what follows the header).

        Raises:
            WireError: the body is malformed in any way.
        """
        try:
            value = quick(body)
            if value is not OTHER:
                return value
            reader = Reader(body, self._names, self._accept_bytes)
            value = reader.take(MAX_DEPTH)
        except WireError:
            raise
        except (struct.error, ValueError, IndexError, OverflowError, KeyError, TypeError) as error:
            raise WireError(f"malformed value: {type(error).__name__}") from None
        if reader.at != len(body):
            raise WireError(f"{len(body) - reader.at} bytes left over after the value")
        if len(body) - reader.bulk > MAX_VALUE_BYTES:
            raise WireError("more than 1 MB of plain values")
        return value
