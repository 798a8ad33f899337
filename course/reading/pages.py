"""Screens of a given height out of rows of any width, and a place in the text that outlives both.

A row is one line of the screen. The layout says for each row which block it belongs to, whether it is blank,
and whether a screen may begin with it. Everything here is arithmetic on that.
"""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = ["Layout", "Place", "Row"]

#: A screen is cut short to keep something whole if at least this much of it stays filled, or this little
#: where what is kept whole fits on the next screen.
_FILLED, _LEAST = 0.5, 0.2


@dataclass(frozen=True, slots=True)
class Row:
    """Facts about one line.

    Attributes:
        block: index of the block it belongs to; -1 for the head of the lesson.
        blank: nothing is on it.
        joined: it belongs to the row above; no screen should begin with it.
        fresh: it takes the rows above as answered; a screen always begins with it.
    """

    block: int
    blank: bool = False
    joined: bool = False
    fresh: bool = False


@dataclass(frozen=True, slots=True)
class Place:
    """Where a reader is, in the text and not on a page.

    Attributes:
        block: index of the block at the top of the screen; -1 is the head of the lesson.
        part: how far into the block, from 0 to 1.
    """

    block: int = -1
    part: float = 0.0


class Layout:
    """A lesson laid out for one width, cut into screens of one height.

    Args:
        rows: every line, in order.
        height: lines on a screen.

    Attributes:
        starts: the first row of each screen.
    """

    def __init__(self, rows: Sequence[Row], height: int) -> None:
        self.rows = rows
        self.height = max(1, height)
        self._spans: dict[int, tuple[int, int]] = {}
        for number, row in enumerate(rows):
            first, _ = self._spans.get(row.block, (number, number))
            self._spans[row.block] = (first, number + 1)
        self.starts = self._cut()

    def __len__(self) -> int:
        return len(self.rows)

    @property
    def last(self) -> int:
        """The first row of the last screen."""
        return self.starts[-1]

    def end_of(self, top: int) -> int:
        """The row after the last one of a screen that begins with row ``top``."""
        end = top + self.height
        fresh = (row for row in range(top + 1, min(end, len(self.rows))) if self.rows[row].fresh)
        if (first_fresh := next(fresh, None)) is not None:
            return first_fresh
        if end >= len(self.rows):
            return len(self.rows)
        for cut in range(end, top + int(self.height * _LEAST), -1):
            if not self.rows[cut].joined:
                first, last = self._spans[self.rows[cut].block]
                fits = last - first <= self.height + 1  # a blank line above it is left out
                return cut if cut - top >= self.height * _FILLED or fits else end
        return end

    def next(self, top: int) -> int:
        """Where the screen after the one at ``top`` begins; the same row at the end."""
        end = self._begin(self.end_of(top))
        return end if end < len(self.rows) else top

    def previous(self, top: int) -> int:
        """Where the screen before the one at ``top`` begins."""
        return next((start for start in reversed(self.starts) if start < top), 0)

    def number(self, top: int) -> int:
        """Which screen a row is on, 1 first."""
        return bisect_right(self.starts, max(0, top))

    def ends(self, top: int) -> bool:
        """Whether the last line is on the screen that begins with row ``top``."""
        return self.end_of(top) >= len(self.rows)

    def place(self, top: int) -> Place:
        """The place in the text of the row at the top."""
        if not self.rows:
            return Place()
        block = self.rows[min(top, len(self.rows) - 1)].block
        first, end = self._spans[block]
        return Place(block, round((top - first) / (end - first), 4))

    def row(self, place: Place) -> int:
        """The row that a place is on here; the nearest there is if its block is not shown."""
        if place.block in self._spans:
            first, end = self._spans[place.block]
            return min(end - 1, first + round(place.part * (end - first)))
        before = [first for block, (first, _) in self._spans.items() if block < place.block]
        return max(before, default=0)

    def span(self, block: int) -> tuple[int, int] | None:
        """First row of a block and the row after its last; None if it is not shown."""
        return self._spans.get(block)

    def _begin(self, row: int) -> int:
        """A screen does not begin with blank lines."""
        while row < len(self.rows) and self.rows[row].blank:
            row += 1
        return row

    def _cut(self) -> list[int]:
        starts = [self._begin(0)] if self.rows else [0]
        while (following := self.next(starts[-1])) > starts[-1]:
            starts.append(following)
        return starts
