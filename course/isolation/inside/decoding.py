"""Bytes to values: a fast way for the arguments of callbacks, and a careful one for everything.

Everything read here comes from untrusted code: every length is checked before it is used.
"""

from __future__ import annotations

from array import array
from typing import TYPE_CHECKING, Any

import numpy as np

from .frames import (
    DTYPES,
    F64,
    FLOAT64,
    I64,
    MAX_ARRAY_BYTES,
    MAX_DEPTH,
    MAX_DIMENSIONS,
    MAX_VALUE_BYTES,
    MAX_VALUES,
    RHS_DEPTH,
    SHAPE,
    TABLE,
    U32,
    Reference,
    Rhs,
    Seed,
    WireError,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from .frames import Names

_N, _T, _F, _I, _FL, _S, _Y = (ord(tag) for tag in "NTFifsy")
_L, _D, _R, _TB, _A, _V, _C, _W, _P, _G = (ord(tag) for tag in "ldrtavcwpg")


#: Stands for what ``quick`` leaves to the careful reader.
OTHER = object()
_QUICK_COUNT = 64


def quick(body: bytes | memoryview) -> Any:  # noqa: PLR0911 - it gives up at the first thing it does not know
    """A vector, or a short list of numbers, words, vectors and tables, as in a callback and its answer.

    Twenty thousand of them pass in a second, so they are read in one loop; ``OTHER`` stands for anything
    else, which takes the long way from the start.
    """
    if len(body) > MAX_VALUE_BYTES:  # larger ones must not be copied twice
        return OTHER
    if body[0] == _V:
        values, end = _quick_vector(body, 1)
        return values if end == len(body) else OTHER
    if body[0] != _L:
        return OTHER
    count, at = U32.unpack_from(body, 1)[0], 5
    if count > _QUICK_COUNT:
        return OTHER
    items: list[Any] = []
    for _ in range(count):
        if body[at] == _FL:
            items.append(F64.unpack_from(body, at + 1)[0])
            at += 9
            continue
        read = _QUICK.get(body[at])
        if read is None:
            return OTHER
        value, at = read(body, at + 1)
        if value is OTHER:
            return OTHER
        items.append(value)
    # A length that runs past the end shows here.
    return items if at == len(body) else OTHER


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
