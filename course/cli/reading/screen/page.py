"""The one widget of the reader: a head line, a screen of the lesson, a position bar, a line of keys."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from rich.cells import cell_len, set_cell_size
from rich.segment import Segment
from rich.style import Style
from textual.strip import Strip
from textual.widget import Widget

from course.cli.reading.screen.printing import BlockRows, Item, ScreenPrinter
from course.reading.record import Layout, Place, Row

#: Lines around the text: a head, a position bar and a line of keys; below this height no head.
_LOW = 16
_MARGIN = 2
_BAR = Style(reverse=True)
_DIM = Style(dim=True)
_HERE = Style(bold=True)
_LINK_HERE = Style(reverse=True)


@dataclass(frozen=True, slots=True)
class Words:
    """The words around the text."""

    head: str = ""
    keys: str = ""
    position: str = ""
    share: float = 0.0


class Book:
    """Every block of a lesson laid out for one width; blocks are laid out anew one at a time.

    Args:
        printer: lays out a block.
        count: of blocks.
        tail: the rows after the last block.
    """

    def __init__(self, printer: ScreenPrinter, count: int, tail: Callable[[], BlockRows]) -> None:
        self._printer = printer
        self._count = count
        self._tail = tail
        self._blocks: dict[int, BlockRows] = {}
        self.lines: list[tuple[Segment, ...]] = []
        self.items: list[Item] = []
        self.layout = Layout((), 1)
        self.whole = False

    @property
    def column(self) -> int:
        """Columns of prose, and of figures."""
        return self._printer.column

    def build(self, height: int, first: int = -1, enough: int | None = None) -> None:
        """Lay out the missing blocks, and cut them into screens.

        Args:
            height: lines of text on a screen.
            first: block to begin with, for a first look.
            enough: stop once there are this many lines.
        """
        order = range(-1, self._count + 1) if enough is None else range(first, self._count + 1)
        self.lines, self.items = [], []
        rows: list[Row] = []
        for index in order:
            made = self._blocks.get(index)
            if made is None:
                made = self._blocks[index] = self._laid_out(index)
            self.items += [replace(item, row=len(rows) + item.row) for item in made.items]
            self.lines += made.lines
            rows += made.rows
            if enough is not None and len(rows) >= enough:
                break
        self.whole = enough is None
        self.layout = Layout(rows, height)

    def forget(self, *indices: int) -> None:
        """Lay these blocks out anew with the next build; all of them if none is named."""
        for index in indices or tuple(self._blocks):
            self._blocks.pop(index, None)

    def _laid_out(self, index: int) -> BlockRows:
        if index < 0:
            return self._printer.head_rows()
        return self._tail() if index == self._count else self._printer.rows(index)


class Page(Widget):
    """Shows a screen of a book. ``top`` is its first row; the mouse and keys are the app's business.

    Attributes:
        paged: a block that would be cut at the foot is left for the next screen.
    """

    DEFAULT_CSS = "Page { width: 100%; height: 100%; }"
    ALLOW_SELECT = False
    can_focus = True

    def __init__(self) -> None:
        super().__init__()
        self.book: Book | None = None
        self.top = 0
        self.item: Item | None = None
        self.words = Words()
        self.paged = True

    @property
    def room(self) -> int:
        """Lines of text on the screen."""
        # The app knows its size before this widget is given its own.
        return max(1, self.app.size.height - (2 if self._low else 3))

    @property
    def _low(self) -> bool:
        return self.app.size.height < _LOW

    @property
    def _lead(self) -> int:
        """Lines above the text."""
        return 0 if self._low else 1

    def left(self, row: int) -> int:
        """Columns before the text: it stands in the middle of a wide window."""
        del row
        widest = self._widest()
        return max(_MARGIN, (self.size.width - widest) // 2)

    def _widest(self) -> int:
        return min(self.size.width, 80)

    def end(self) -> int:
        """The row after the last one on the screen."""
        if self.book is None:
            return 0
        layout = self.book.layout
        return layout.end_of(self.top) if self.paged else min(len(layout), self.top + self.room)

    def go(self, top: int, *, paged: bool = True) -> None:
        """Show the screen that begins with a row; ``paged`` leaves a block that would be cut for later."""
        if self.book is None:
            return
        self.top = max(0, min(top, len(self.book.layout) - 1))
        self.paged = paged
        self.refresh()

    def place(self) -> Place | None:
        """Where the reader is, in the text."""
        return self.book.layout.place(self.top) if self.book is not None and len(self.book.layout) else None

    def item_at(self, x: int, y: int) -> Item | None:
        """The item at a cell of the screen: a link by its letters, the rest by its rows."""
        row = self.top + y - self._lead
        if self.book is None or not 0 <= y - self._lead < self.end() - self.top:
            return None
        column = self.left(row)
        for segment in self.book.lines[row]:
            width = cell_len(segment.text)
            if column <= x < column + width and segment.style and "link" in segment.style.meta:
                number = segment.style.meta["link"]
                block = self.book.layout.rows[row].block
                return next(
                    (
                        i
                        for i in self.book.items
                        if i.kind == "link" and (i.block, i.number) == (block, number)
                    ),
                    None,
                )
            column += width
        block = self.book.layout.rows[row].block
        return next((i for i in self.book.items if i.kind != "link" and i.block == block), None)

    def items(self) -> list[Item]:
        """The items on this screen, from top to bottom."""
        if self.book is None:
            return []
        end, spans = self.end(), self.book.layout.span
        seen = []
        for item in self.book.items:
            span = spans(item.block)
            if item.kind == "link":
                visible = self.top <= item.row < end
            else:
                # A long cell is still at hand when its first line is above the screen.
                visible = span is not None and span[0] < end and span[1] > self.top + 1
            if visible:
                seen.append(item)
        return seen

    # -- drawing ---------------------------------------------------------------------------------------

    def render_line(self, y: int) -> Strip:
        """One line of the screen."""
        width, height = self.size
        if y == height - 1:
            return self._bar(self.words.keys, width)
        if y == height - 2:
            return self._position(width)
        if y == 0 and not self._low:
            return self._bar(self.words.head, width)
        row = self.top + y - self._lead
        if self.book is None or row >= self.end():
            return Strip.blank(width)
        mark = self._mark(row)
        left = self.left(row)
        before = Segment(" " * (left - 2) + f"{mark} ", _HERE)
        item = self.item
        pieces = [before]
        for segment in self.book.lines[row]:
            if item is not None and item.kind == "link" and self._is_link(segment, row, item):
                pieces.append(Segment(segment.text, (segment.style or Style()) + _LINK_HERE))
            else:
                pieces.append(segment)
        return Strip(pieces).adjust_cell_length(width)

    def _mark(self, row: int) -> str:
        """The sign before the line of what the keys act on."""
        item = self.item
        if item is None or item.kind == "link":
            return " "
        return "▸" if row == max(item.row, self.top) else " "

    def _is_link(self, segment: Segment, row: int, item: Item) -> bool:
        assert self.book is not None
        meta = segment.style.meta if segment.style else {}
        return meta.get("link") == item.number and self.book.layout.rows[row].block == item.block

    def _bar(self, text: str, width: int) -> Strip:
        return Strip([Segment(set_cell_size(f" {text}", width), _BAR)], width)

    def _position(self, width: int) -> Strip:
        text = f" {self.words.position}"
        room = width - cell_len(text) - 3
        if room < 8:
            return Strip([Segment(set_cell_size(text, width), _DIM)], width)
        done = round(room * self.words.share)
        return Strip(
            [
                Segment("  "),
                Segment("━" * done, _HERE),
                Segment("─" * (room - done), _DIM),
                Segment(text + " ", _DIM),
            ]
        ).adjust_cell_length(width)
