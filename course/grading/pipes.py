"""Frames on the pipes between our own processes: a 4-byte little-endian length, then msgpack.

Also the limits of such a process where it reads untrusted files.
"""

from __future__ import annotations

import struct
from time import process_time
from typing import IO, Any

import msgspec

try:
    import resource
except ImportError:  # Windows has none of these limits
    resource = None  # type: ignore[assignment]

__all__ = ["limit_cpu", "limit_memory", "read_frame", "write_frame"]

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


def limit_memory(size: int) -> None:
    """Limit this process's memory from now on, in bytes; it leaves no core file either."""
    if resource is not None:
        resource.setrlimit(resource.RLIMIT_AS, (size, size))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def limit_cpu(seconds: int) -> None:
    """End this process once it has used so much more CPU time than by now; a later call begins anew."""
    if resource is not None:
        _, hard = resource.getrlimit(resource.RLIMIT_CPU)
        resource.setrlimit(resource.RLIMIT_CPU, (int(process_time()) + seconds + 1, hard))
