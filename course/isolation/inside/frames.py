"""Shared by both ends of the wire: limits, kinds of message, placeholders for values that cannot cross."""

from __future__ import annotations

import enum
import signal
import struct
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

MAX_VALUE_BYTES = 1 << 20  # everything of a frame that is not array data
#: All arrays of a frame together. The largest that any accepted solution of the course returns have 1 MB.
MAX_ARRAY_BYTES = 8 << 20
MAX_FRAME = MAX_VALUE_BYTES + MAX_ARRAY_BYTES
MAX_DEPTH = 32
MAX_DIMENSIONS = 8
RHS_DEPTH = 4  # of the parameters of a right-hand side
MAX_VALUES = 200_000  # 60,000 arrays of one number, the dearest frame tried, took 0.08 s of CPU to decode

HEADER = struct.Struct("<IB")
U32 = struct.Struct("<I")
I64 = struct.Struct("<q")
F64 = struct.Struct("<d")
SHAPE = struct.Struct("<II")
TABLE = b"\x00\x02"  # dtype and dimensions of a table of float64
FLOAT64 = np.dtype(np.float64)
#: How a worker ended, as its parent reports it: the status as wait(2) has it, then seconds and microseconds
#: of user and of system time.
ENDED = struct.Struct("@l4l")
#: By which a worker is asked where its code is; None where there are no such signals (Windows). It answers
#: once it was asked ``LOOKS`` times: what is there each time is what does not end.
LOOK: signal.Signals | None = getattr(signal, "SIGUSR1", None)
LOOKS = 4
DTYPES = (np.dtype("<f8"), np.dtype("<i8"), np.dtype("?"), np.dtype("<c16"))


def room_for(size: int, begun: bytes) -> memoryview:
    """Memory for a frame whose first bytes have arrived; it is taken only as the rest arrives."""
    room = np.empty(size, np.uint8).data
    room[: len(begun)] = begun
    return room


class Kind(enum.IntEnum):
    """The kind of a frame. The first group goes to the worker, the second comes from it."""

    LOAD = 1  # [files, module name]
    CALL = 2  # [function, args, kwargs, inspect]
    MARCH = 3  # [step, [[rhs, q0, v0, t0, h, n], ...]]
    REPLY = 4  # value of a callback
    EACH = 6  # [function, [args, ...]]
    FOLD = 7  # [function, state, [args, ...], which element is the next state or None, keys to keep or None]
    REPLY_RAISE = 5  # [exception name, message]: the callback refused its arguments
    READY = 15  # None: locked down, and nothing of the submission has run yet
    LOADED = 16  # names of functions, and what was left out of the module
    REFUSED = 17  # {stage, type, message, line, text}
    RESULT = 18  # value
    RAISED = 19  # {type, message, line, function, frames}
    CALLBACK = 20  # [number of the callable, kwargs or None, *args]
    STUCK = 21  # {frames, lines}: frames that were there at each look, and lines of the innermost


class WireError(Exception):
    """The data is not a frame of this protocol."""


class UnsupportedValueError(Exception):
    """A value that cannot cross; the message names its type in words for the student."""


@dataclass(frozen=True, slots=True)
class Rhs:
    """A named right-hand side and its plain parameters, built where it is evaluated."""

    name: str
    params: dict[str, Any]


@dataclass(frozen=True, slots=True)
class Seed:
    """A random generator, as the seed it is built from on the other side."""

    value: int


@dataclass(frozen=True, slots=True)
class Reference:
    """A callable by number. ``mine``: the receiver holds it and has said so before."""

    number: int
    mine: bool


class Names(Protocol):
    """How one side turns its objects into references and back."""

    def lower(self, value: Any) -> Reference | Rhs | Seed | None:
        """The placeholder of ``value`` on the wire, or None if it cannot cross."""

    def raise_(self, value: Reference | Rhs | Seed) -> Any:
        """The object here behind a reference, right-hand side or seed that arrived."""
