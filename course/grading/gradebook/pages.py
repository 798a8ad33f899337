"""The rows on the pages of an SQLite file, read without SQLite, for a file that SQLite refuses.

Nothing in the file is trusted: no header, no pointer, no length. Every page is read by itself, in any order;
a row that continues on other pages is followed there. The rows are raw, and some are nonsense; ``salvage``
keeps those whose own digest matches.

The format: https://www.sqlite.org/fileformat2.html (sections 1.3, 1.6, 1.7 and 2.1).
"""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

__all__ = ["Cell", "raw_rows"]

#: A value as SQLite stores it.
Cell = None | int | float | str | bytes

_MAGIC = b"SQLite format 3\0"
_USUAL_PAGE = 4096
_TABLE_LEAF, _INDEX_LEAF, _INDEX_INTERIOR = 0x0D, 0x0A, 0x02
_MOST_COLUMNS = 32
_INTEGERS = {1: 1, 2: 2, 3: 3, 4: 4, 5: 6, 6: 8}


class _DamagedError(Exception):
    """A row cannot be read."""


def raw_rows(data: bytes) -> Iterator[tuple[int | None, tuple[Cell, ...]]]:
    """Everything that can be read as a row, with its number if it has one.

    Args:
        data: a whole file.
    """
    size, reserved = _sizes(data)
    pages = _Pages(data, size, size - reserved)
    for number in range(len(data) // size):
        yield from pages.rows(number)


def _sizes(data: bytes) -> tuple[int, int]:
    """Bytes in a page, and the unused ones of these; from the header, or our own values if it is damaged."""
    if data[:16] == _MAGIC:
        size = struct.unpack(">H", data[16:18])[0]
        size = 65536 if size == 1 else size
        if 512 <= size <= 65536 and size & (size - 1) == 0 and data[20] < 64:
            return size, data[20]
    return _USUAL_PAGE, 0


class _Pages:
    def __init__(self, data: bytes, size: int, usable: int) -> None:
        self._data = data
        self._size = size
        self._usable = usable

    def rows(self, number: int) -> Iterator[tuple[int | None, tuple[Cell, ...]]]:
        """The rows that begin on one page."""
        page = self._data[number * self._size : (number + 1) * self._size]
        head = 100 if number == 0 else 0
        kind = page[head]
        if kind not in {_TABLE_LEAF, _INDEX_LEAF, _INDEX_INTERIOR}:
            return
        pointers = head + (12 if kind == _INDEX_INTERIOR else 8)
        count = min(struct.unpack(">H", page[head + 3 : head + 5])[0], (self._size - pointers) // 2)
        for (at,) in struct.iter_unpack(">H", page[pointers : pointers + 2 * count]):
            try:
                yield self._row(page, at, kind)
            except (_DamagedError, IndexError, struct.error, UnicodeDecodeError):
                continue  # of this row nothing is left

    def _row(self, page: bytes, at: int, kind: int) -> tuple[int | None, tuple[Cell, ...]]:
        if kind == _INDEX_INTERIOR:
            at += 4
        length, at = _varint(page, at)
        number = None
        if kind == _TABLE_LEAF:
            number, at = _varint(page, at)
        return number, _record(self._payload(page, at, length, kind))

    def _payload(self, page: bytes, at: int, length: int, kind: int) -> bytes:
        """The bytes of a row, those on overflow pages included."""
        usable = self._usable
        if length > len(self._data):
            raise _DamagedError
        most = usable - 35 if kind == _TABLE_LEAF else (usable - 12) * 64 // 255 - 23
        here = length
        if length > most:
            least = (usable - 12) * 32 // 255 - 23
            here = least + (length - least) % (usable - 4)
            here = here if here <= most else least
        found = [page[at : at + here]]
        left = length - here
        following = struct.unpack(">I", page[at + here : at + here + 4])[0] if left else 0
        seen: set[int] = set()
        while left > 0:
            start = (following - 1) * self._size
            if following in seen or following < 2 or start + self._size > len(self._data):
                raise _DamagedError
            seen.add(following)
            following = struct.unpack(">I", self._data[start : start + 4])[0]
            found.append(self._data[start + 4 : start + 4 + min(left, usable - 4)])
            left -= len(found[-1])
        body = b"".join(found)
        if len(body) != length:
            raise _DamagedError
        return body


def _varint(data: bytes, at: int) -> tuple[int, int]:
    """A number of one to nine bytes, and where it ends."""
    value = 0
    for _ in range(8):
        byte = data[at]
        at += 1
        value = value << 7 | byte & 0x7F
        if byte < 0x80:
            return value, at
    return value << 8 | data[at], at + 1


def _record(body: bytes) -> tuple[Cell, ...]:
    """The values of a row.

    Raises:
        _DamagedError: these are none.
    """
    end, at = _varint(body, 0)
    if end > len(body):
        raise _DamagedError
    kinds = []
    while at < end:
        kind, at = _varint(body, at)
        kinds.append(kind)
        if len(kinds) > _MOST_COLUMNS:
            raise _DamagedError
    values = []
    for kind in kinds:
        value, at = _value(body, at, kind)
        values.append(value)
    if at != len(body):
        raise _DamagedError
    return tuple(values)


def _value(body: bytes, at: int, kind: int) -> tuple[Cell, int]:
    if kind in {0, 8, 9}:
        return (None, 0, 1)[max(0, kind - 7)], at
    if kind in _INTEGERS:
        end = at + _INTEGERS[kind]
        return int.from_bytes(body[at:end], "big", signed=True), end
    if kind == 7:
        return struct.unpack(">d", body[at : at + 8])[0], at + 8
    if kind < 12:
        raise _DamagedError
    end = at + (kind - 12) // 2
    if end > len(body):
        raise _DamagedError
    return (body[at:end].decode() if kind % 2 else body[at:end]), end
