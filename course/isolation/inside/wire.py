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

This file runs on both sides and is copied next to a stranger's code, so it imports the standard library and
numpy and nothing of this course. Whatever arrives is a claim by an untrusted sender: every length is checked
before it is used, and the only exception that leaves this file is ``WireError``.
"""

from __future__ import annotations

import enum
import signal
import struct
from array import array
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    Parts = list[bytes | memoryview]

# ---
# Limits, kinds of message, placeholders for values that cannot cross.

MAX_VALUE_BYTES = 1 << 20  # everything of a frame that is not array data
#: All arrays of a frame together. The largest that any accepted solution of the course returns have 1 MB.
MAX_ARRAY_BYTES = 8 << 20
MAX_FRAME = MAX_VALUE_BYTES + MAX_ARRAY_BYTES
MAX_DEPTH = 32
MAX_DIMENSIONS = 8
RHS_DEPTH = 4  # of the parameters of a right-hand side
MAX_VALUES = 200_000  # 60,000 arrays of one number, the dearest frame tried, took 0.08 s of CPU to decode
#: Bytes that are kept of what a submission prints; what ends those of one that prints more.
MAX_OUTPUT = 64 << 10
CUT = f"...\n(The rest of the output was dropped: {MAX_OUTPUT >> 10} KB are kept.)\n"

HEADER = struct.Struct("<IB")
U32 = struct.Struct("<I")
I64 = struct.Struct("<q")
F64 = struct.Struct("<d")
SHAPE = struct.Struct("<II")
TABLE = b"\x00\x02"  # dtype and dimensions of a table of float64
FLOAT64 = np.dtype(np.float64)
#: How a worker ended, as its parent reports it: the status as wait(2) has it.
ENDED = struct.Struct("@i")
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

    LOAD = 1  # [files, module name, functions that are needed, or none for all]
    CALL = 2  # [function, args, kwargs, inspect]
    MARCH = 3  # [step, [[rhs, q0, v0, t0, h, n], ...]]
    REPLY = 4  # value of a callback
    EACH = 6  # [function, [args, ...]]
    FOLD = 7  # [function, state, [args, ...], keys to keep or None]
    REPLY_RAISE = 5  # "exception's name: message": the callback refused its arguments
    READY = 15  # None: locked down, and nothing of the submission has run yet
    LOADED = 16  # names of functions, and what was left out of the module
    REFUSED = 17  # as RAISED, with stage; instead of READY, the layer that could not be locked down
    RESULT = 18  # value
    RAISED = 19  # {type, message, frames, bases}; of a SyntaxError line and text, too
    CALLBACK = 20  # [number of the callable, kwargs or None, *args]
    STUCK = 21  # {frames, lines}: frames that were there at each look, and lines of the innermost


class WireError(Exception):
    """The data is not a frame of this protocol."""


class UnsupportedValueError(Exception):
    """A value that cannot cross; the message names its type in words for the student."""


class TooMuchError(UnsupportedValueError):
    """A value that is plain, but too large or too deep to cross."""


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


# ---
# Values to bytes: one function per type, found by the exact type of a value.

_PLAIN_LISTS = frozenset((list, tuple))
_FLOATS = frozenset((float, np.float64))
#: Arrays from this size on are not copied before the frame is put together, bytes.
_LARGE = 1 << 14
_WIDEN = {"f": 0, "i": 1, "u": 1, "b": 2, "c": 3}


def put(value: Any, parts: Parts, names: Names | None, depth: int) -> int:
    """Append the encoding of ``value`` to ``parts``; returns how many bytes of it are array data."""
    return _PUT.get(type(value), _put_other)(value, parts, names, depth)


def _put_none(_value: None, parts: Parts, _names: Names | None, _depth: int) -> int:
    parts.append(b"N")
    return 0


def _put_bool(value: Any, parts: Parts, _names: Names | None, _depth: int) -> int:
    parts.append(b"T" if value else b"F")
    return 0


def _put_int(value: Any, parts: Parts, _names: Names | None, _depth: int) -> int:
    try:
        parts.append(b"i" + I64.pack(value))
    except struct.error:
        raise UnsupportedValueError("an integer beyond 64 bits") from None
    return 0


def _put_float(value: Any, parts: Parts, _names: Names | None, _depth: int) -> int:
    parts += (b"f", F64.pack(value))
    return 0


def _put_str(value: Any, parts: Parts, _names: Names | None, _depth: int) -> int:
    raw = value.encode("utf-8", "replace")
    parts.append(b"s" + U32.pack(len(raw)) + raw)
    return 0


def _put_bytes(value: bytes, parts: Parts, _names: Names | None, _depth: int) -> int:
    parts.append(b"y" + U32.pack(len(value)) + value)
    return len(value)


def _put_list(value: Any, parts: Parts, names: Names | None, depth: int) -> int:
    if depth <= 0:
        raise TooMuchError(f"a value nested more than {MAX_DEPTH} deep")
    if value and type(value) in _PLAIN_LISTS:  # a relative may lie about what is in it
        first = type(value[0])
        if first in _FLOATS and _FLOATS.issuperset(map(type, value)):
            parts += (b"r", U32.pack(len(value)), array("d", value).tobytes())
            return 0
        if first is dict and len(value) > 1 and _are_records(value):
            return _put_records(value, parts, names, depth - 1)
    parts.append(b"l" + U32.pack(len(value)))
    arrays = 0
    for item in value:
        write = _PUT.get(type(item), _put_other)
        arrays += write(item, parts, names, depth - 1)
    return arrays


def _are_records(value: Any) -> bool:
    keys = list(value[0])
    return bool(keys) and all(type(item) is dict and list(item) == keys for item in value)


def _put_records(value: Any, parts: Parts, names: Names | None, depth: int) -> int:
    """Dicts with the same keys, each key's values as one list: the states of a simulation."""
    parts.append(b"t" + U32.pack(len(value[0])))
    arrays = 0
    for key in value[0]:
        _put_key(key, parts)
        arrays += _put_list([item[key] for item in value], parts, names, depth)
    return arrays


def _put_key(key: Any, parts: Parts) -> None:
    if not isinstance(key, str):
        raise UnsupportedValueError(f"a dict with a key that is not a str but {_name_of(key)}")
    raw = key.encode("utf-8", "replace")
    parts.append(U32.pack(len(raw)) + raw)


def _put_dict(value: Any, parts: Parts, names: Names | None, depth: int) -> int:
    if depth <= 0:
        raise TooMuchError(f"a value nested more than {MAX_DEPTH} deep")
    parts.append(b"d" + U32.pack(len(value)))
    arrays = 0
    for key, item in value.items():
        _put_key(key, parts)
        arrays += put(item, parts, names, depth - 1)
    return arrays


def _put_array(value: Any, parts: Parts, _names: Names | None, _depth: int) -> int:
    if value.dtype is FLOAT64 and value.ndim == 1:  # what nearly every call and callback carries
        parts += (b"v", U32.pack(len(value)), _raw(value))
        return int(value.nbytes)
    if value.dtype is FLOAT64 and value.ndim == 2:
        parts += (b"a" + TABLE, SHAPE.pack(*value.shape), _raw(value))
        return int(value.nbytes)
    code = _WIDEN.get(value.dtype.kind)
    if code is None:
        raise UnsupportedValueError(f"an array of dtype {value.dtype}")
    if value.ndim > MAX_DIMENSIONS:
        raise UnsupportedValueError(f"an array of {value.ndim} dimensions")
    raw = value.astype(DTYPES[code], copy=False).tobytes()
    parts.append(b"a%c%c" % (code, value.ndim) + b"".join(map(U32.pack, value.shape)) + raw)
    return len(raw)


def _raw(value: Any) -> bytes | memoryview:
    return value.tobytes() if value.nbytes < _LARGE else np.ascontiguousarray(value).data.cast("B")


def _put_other(value: Any, parts: Parts, names: Names | None, depth: int) -> int:
    """Everything whose exact type has no entry: numpy scalars, subclasses, callables, strangers."""
    if not isinstance(value, _FAMILIAR):
        return _put_lowered(value, parts, names, depth)
    if isinstance(value, np.ndarray):
        return _put_array(np.asarray(value), parts, names, depth)
    if isinstance(value, np.generic):
        if value.dtype.kind not in _WIDEN:
            raise UnsupportedValueError(f"a numpy scalar of dtype {value.dtype}")
        if value.dtype.kind == "c":
            return _put_array(np.asarray(value), parts, names, depth)
        return put(value.item() if value.dtype.itemsize <= 8 else float(value), parts, names, depth)
    if isinstance(value, complex):
        return _put_array(np.asarray(complex(value)), parts, names, depth)
    base = next(base for base in _BASES if isinstance(value, base))
    return _PUT[base](value, parts, names, depth)


def _put_lowered(value: Any, parts: Parts, names: Names | None, depth: int) -> int:
    """A callable, a right-hand side or a generator; nothing else can cross."""
    lowered = names.lower(value) if names is not None else None
    if isinstance(lowered, Reference):
        parts.append((b"c" if lowered.mine else b"w") + U32.pack(lowered.number))
    elif isinstance(lowered, Rhs):
        parts.append(b"p")
        _put_str(lowered.name, parts, None, 1)
        _put_dict(lowered.params, parts, None, min(depth, RHS_DEPTH))
    elif isinstance(lowered, Seed):
        parts.append(b"g" + I64.pack(lowered.value))
    else:
        raise UnsupportedValueError(f"a value of type {_name_of(value)}")
    return 0


def _name_of(value: Any) -> str:
    return str(type(value).__name__)[:80]


_PUT: dict[type, Callable[[Any, Parts, Names | None, int], int]] = {
    float: _put_float,
    np.float64: _put_float,
    np.ndarray: _put_array,
    int: _put_int,
    list: _put_list,
    tuple: _put_list,
    type(None): _put_none,
    bool: _put_bool,
    str: _put_str,
    dict: _put_dict,
    bytes: _put_bytes,
}
#: Subclasses arrive as the plain value they extend; bool before int, since every bool is an int.
_BASES = (bool, float, int, str, list, tuple, dict)
_FAMILIAR = (np.ndarray, np.generic, complex, *_BASES)


# ---
# Bytes to values: a fast way for the arguments of callbacks, and a careful one for everything.

_N, _T, _F, _I, _FL, _S, _Y = (ord(tag) for tag in "NTFifsy")
_L, _D, _R, _TB, _A, _V, _C, _W, _P, _G = (ord(tag) for tag in "ldrtavcwpg")


#: Stands for what ``quick`` leaves to the careful reader.
OTHER = object()
_QUICK_COUNT, _QUICK_DEPTH = 64, 3


def quick(body: bytes | memoryview) -> Any:
    """A vector, or short lists of numbers, words, vectors and tables, as in a callback and in most answers.

    Twenty thousand of them pass in a second, so they are read in one loop; ``OTHER`` stands for anything
    else, which takes the long way from the start.
    """
    if len(body) > MAX_VALUE_BYTES:  # larger ones must not be copied twice
        return OTHER
    if body[0] == _V:
        value, end = _quick_vector(body, 1)
    else:
        value, end = _quick_list(body, 1, _QUICK_DEPTH) if body[0] == _L else (OTHER, 0)
    # A length that runs past the end shows here.
    return value if end == len(body) else OTHER


def _quick_list(body: bytes | memoryview, at: int, depth: int) -> tuple[Any, int]:
    count, at = U32.unpack_from(body, at)[0], at + 4
    if count > _QUICK_COUNT or not depth:
        return OTHER, at
    items: list[Any] = []
    for _ in range(count):
        tag = body[at]
        if tag == _FL:
            items.append(F64.unpack_from(body, at + 1)[0])
            at += 9
            continue
        if tag == _L:
            value, at = _quick_list(body, at + 1, depth - 1)
        elif tag in _QUICK:
            value, at = _QUICK[tag](body, at + 1)
        else:
            return OTHER, at
        if value is OTHER:
            return OTHER, at
        items.append(value)
    return items, at


def _quick_vector(body: bytes | memoryview, at: int) -> tuple[Any, int]:
    end = at + 4 + 8 * U32.unpack_from(body, at)[0]
    # Writable, and aligned as malloc aligns.
    return (np.frombuffer(bytearray(body[at + 4 : end]), FLOAT64) if end <= len(body) else OTHER), end


def _quick_table(body: bytes | memoryview, at: int) -> tuple[Any, int]:
    if body[at : at + 2] != TABLE:
        return OTHER, at
    rows, columns = SHAPE.unpack_from(body, at + 2)
    end = at + 10 + 8 * rows * columns
    # Empty ones may have extents that overflow: those are for the careful reader.
    if end > len(body) or not rows * columns:
        return OTHER, at
    return np.frombuffer(bytearray(body[at + 10 : end]), FLOAT64).reshape(rows, columns), end


def _quick_row(body: bytes | memoryview, at: int) -> tuple[Any, int]:
    end = at + 4 + 8 * U32.unpack_from(body, at)[0]
    return (array("d", bytes(body[at + 4 : end])).tolist() if end <= len(body) else OTHER), end


def _quick_text(body: bytes | memoryview, at: int) -> tuple[Any, int]:
    end = at + 4 + U32.unpack_from(body, at)[0]
    return (str(body[at + 4 : end], "utf-8") if end <= len(body) else OTHER), end


_QUICK: dict[int, Callable[[bytes | memoryview, int], tuple[Any, int]]] = {
    _V: _quick_vector,
    _A: _quick_table,
    _R: _quick_row,
    _S: _quick_text,
    _I: lambda body, at: (I64.unpack_from(body, at)[0], at + 8),
    _N: lambda _body, at: (None, at),
    _T: lambda _body, at: (True, at),
    _F: lambda _body, at: (False, at),
}


class Reader:
    """Walks one body; ``at`` is where the next value starts."""

    __slots__ = ("_accept_bytes", "_names", "_values", "at", "body", "bulk")

    def __init__(self, body: bytes | memoryview, names: Names | None, accept_bytes: bool) -> None:
        self.body = body
        self.at = 0
        self._names = names
        self._accept_bytes = accept_bytes
        self._values = MAX_VALUES
        self.bulk = 0  # bytes of arrays and files so far

    def take(self, depth: int) -> Any:  # noqa: PLR0911 - one return per kind of value
        at = self.at
        tag = self.body[at]
        self.at = at + 1
        self._values -= 1
        if self._values < 0:
            raise WireError(f"more than {MAX_VALUES} values")
        if tag == _FL:
            self.at = at + 9
            return F64.unpack_from(self.body, at + 1)[0]
        if tag in (_V, _A):
            return self._array(vector=tag == _V)
        if tag == _I:
            self.at = at + 9
            return I64.unpack_from(self.body, at + 1)[0]
        if tag in _CONSTANTS:
            return _CONSTANTS[tag]
        if tag == _S:
            return self._text()
        if tag == _R:
            return self._row()
        if tag in (_L, _D, _TB):
            if depth <= 0:
                raise WireError(f"nested more than {MAX_DEPTH} deep")
            return (self._list if tag == _L else self._dict if tag == _D else self._records)(depth - 1)
        return self._rare(tag, depth)

    def _rare(self, tag: int, depth: int) -> Any:
        if tag == _Y and self._accept_bytes:
            raw = self._raw()
            self.bulk += len(raw)
            return raw
        if self._names is None:
            raise WireError(f"unexpected tag {tag}")
        if tag in (_C, _W):
            # "c": the receiver (this side) holds it; "w": the sender does.
            return self._names.raise_(Reference(self._u32(), mine=tag == _C))
        if tag == _P:
            # One inside another would recurse without ever using up the depth.
            if depth <= 0 or self.body[self.at] != _S:
                raise WireError("a right-hand side in another form")
            name, params = self.take(0), self.take(min(depth, RHS_DEPTH))
            if not isinstance(params, dict):
                raise WireError("a right-hand side in another form")
            return self._names.raise_(Rhs(name, params))
        if tag == _G:
            self.at += 8
            return self._names.raise_(Seed(I64.unpack_from(self.body, self.at - 8)[0]))
        raise WireError(f"unexpected tag {tag}")

    def _u32(self) -> int:
        at = self.at
        self.at = at + 4
        return int(U32.unpack_from(self.body, at)[0])

    def _raw(self) -> bytes:
        size = self._u32()
        raw = bytes(self.body[self.at : self.at + size])
        if len(raw) != size:
            raise WireError("a length that runs past the end")
        self.at += size
        return raw

    def _text(self) -> str:
        size = U32.unpack_from(self.body, self.at)[0]
        # Before it is decoded: one wide character makes text take four bytes for each of its letters.
        if self.at + 4 + size - self.bulk > MAX_VALUE_BYTES:
            raise WireError("more than 1 MB of plain values")
        return self._raw().decode("utf-8")

    def _count(self) -> int:
        count = self._u32()
        if count > len(self.body) - self.at:
            raise WireError("more elements than bytes")
        return count

    def _list(self, depth: int) -> list[Any]:
        return [self.take(depth) for _ in range(self._count())]

    def _dict(self, depth: int) -> dict[str, Any]:
        result: dict[str, Any] = {}
        for _ in range(self._count()):
            key = self._text()
            if key in result:
                raise WireError("a key that appears twice")
            result[key] = self.take(depth)
        return result

    def _row(self) -> list[float]:
        """A list of floats."""
        count = self._u32()
        self._count_values(count)
        start, self.at = self.at, self.at + 8 * count
        if self.at > len(self.body):
            raise WireError("a list that runs past the end")
        return array("d", bytes(self.body[start : self.at])).tolist()

    def _records(self, depth: int) -> list[dict[str, Any]]:
        """Dicts with the same keys, from one list for each key."""
        columns: dict[str, list[Any]] = {}
        for _ in range(self._count()):
            key = self._text()
            if key in columns or self.body[self.at] not in (_L, _R, _TB):
                raise WireError("records in another form")
            columns[key] = self.take(depth)
        lengths = {len(column) for column in columns.values()}
        if len(lengths) != 1:
            raise WireError("records of different lengths")
        self._count_values(lengths.pop())
        return [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]

    def _count_values(self, count: int) -> None:
        self._values -= count
        if self._values < 0:
            raise WireError(f"more than {MAX_VALUES} values")

    def _array(self, *, vector: bool) -> np.ndarray[Any, Any]:
        if vector:
            code = 0
            shape: tuple[int, ...] = (self._u32(),)
        else:
            code, ndim = self.body[self.at], self.body[self.at + 1]
            self.at += 2
            if code >= len(DTYPES) or ndim > MAX_DIMENSIONS:
                raise WireError("an array of unknown dtype or too many dimensions")
            shape = tuple(self._u32() for _ in range(ndim))
        dtype = DTYPES[code]
        elements = 1
        rows = 1  # of an empty array: it has no bytes, and as many as its other extents say
        for extent in shape:
            elements *= extent
            rows *= max(extent, 1)
        size = elements * dtype.itemsize
        self.bulk += size
        if self.bulk > MAX_ARRAY_BYTES:
            raise WireError("more than 8 MB of arrays")
        if not elements:
            self._count_values(rows)
        if self.at + size > len(self.body):
            raise WireError("an array that runs past the end")
        raw = np.frombuffer(self.body, np.uint8 if code == 2 else dtype, elements, self.at)
        self.at += size
        # A bool array whose bytes are not 0 or 1 would compare in undefined ways: "!= 0" normalises.
        values = raw != 0 if code == 2 else raw.copy()
        return values.reshape(shape)


_CONSTANTS = {_N: None, _T: True, _F: False}


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
            UnsupportedValueError: something in ``value`` cannot cross.
            TooMuchError: it is too large or too deep.
        """
        parts: list[bytes | memoryview] = [_NO_HEADER]
        arrays = put(value, parts, self._names, MAX_DEPTH)
        frame = bytearray().join(parts)
        size = len(frame) - HEADER.size
        if size - arrays > MAX_VALUE_BYTES or arrays > MAX_ARRAY_BYTES:
            raise TooMuchError("a value that is too large (1 MB of plain values, 8 MB of arrays)")
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
