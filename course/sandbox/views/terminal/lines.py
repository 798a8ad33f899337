"""Two widgets that send only what changed: a canvas of cells and a few lines of text."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from rich.color import Color
from rich.segment import Segment
from rich.style import Style
from textual.geometry import Region
from textual.strip import Strip
from textual.widget import Widget

if TYPE_CHECKING:
    from collections.abc import Sequence

    from course.sandbox.views.terminal.picture import Cells
    from course.sandbox.views.terminal.words import Line

__all__ = ["Canvas", "Lines"]

#: Pairs of colours kept; a scene has some hundreds.
_STYLES = 8192
_PLAIN = Style()


class Canvas(Widget):
    """Shows cells; sends the rows that differ from the last frame, from first to last difference."""

    DEFAULT_CSS = "Canvas { width: 1fr; height: 1fr; }"
    ALLOW_SELECT = False

    def __init__(self, *, colour: bool, id: str | None = None) -> None:  # noqa: A002
        super().__init__(id=id)
        #: Rows sent so far; read by measurements.
        self.sent = 0
        self._colour = colour
        self._cells: Cells | None = None
        self._styles: dict[int, Style] = {}

    def show(self, cells: Cells) -> None:
        """The next frame."""
        changes = cells.changes(self._cells)
        self._cells = cells
        if changes:
            self.sent += len(changes)
            self.refresh(*(Region(first, row, count, 1) for row, first, count in changes))

    @property
    def cells(self) -> Cells | None:
        """The frame that is shown."""
        return self._cells

    def render_line(self, y: int) -> Strip:
        """One row of cells."""
        cells, width = self._cells, self.size.width
        if cells is None or y >= cells.char.shape[0]:
            return Strip.blank(width)
        text = cells.char[y].astype("<u4").tobytes().decode("utf-32-le")
        if not self._colour:
            return Strip([Segment(text, _PLAIN)], len(text)).adjust_cell_length(width, _PLAIN)
        keys = cells.ink[y].astype(np.int64) << 24 | cells.paper[y]
        starts = [0, *(np.flatnonzero(np.diff(keys)) + 1).tolist(), len(text)]
        pairs = keys[starts[:-1]].tolist()
        strip = Strip(
            [
                Segment(text[a:b], self._style(key))
                for a, b, key in zip(starts[:-1], starts[1:], pairs, strict=True)
            ],
            len(text),
        )
        return strip if len(text) == width else strip.adjust_cell_length(width, _PLAIN)

    def _style(self, key: int) -> Style:
        style = self._styles.get(key)
        if style is None:
            if len(self._styles) >= _STYLES:
                self._styles.clear()
            style = self._styles[key] = Style(color=_colour(key >> 24), bgcolor=_colour(key & 0xFFFFFF))
        return style


class Lines(Widget):
    """Shows lines of text, and sends those that changed.

    Args:
        ink, paper: colours; None for the terminal's own.
    """

    ALLOW_SELECT = False

    def __init__(self, ink: str | None, paper: str | None, id: str | None = None) -> None:  # noqa: A002
        super().__init__(id=id)
        self._base = Style(color=ink, bgcolor=paper)
        self._in_colour = ink is not None
        self._lines: list[Line] = []
        self._named: dict[str, Style] = {}

    @property
    def text(self) -> str:
        """The lines, without styles."""
        return "\n".join("".join(piece for piece, _ in line) for line in self._lines)

    def show(self, lines: Sequence[Line]) -> None:
        """Replace the lines."""
        before, self._lines = self._lines, list(lines)
        width, height = self.size
        most = max(len(before), len(self._lines))
        changed = [
            row
            for row in range(min(most, height))
            if row >= len(before) or row >= len(self._lines) or before[row] != self._lines[row]
        ]
        if changed:
            self.refresh(*(Region(0, row, width, 1) for row in changed))

    def render_line(self, y: int) -> Strip:
        """One line."""
        width = self.size.width
        if y >= len(self._lines):
            return Strip.blank(width, self._base)
        pieces = [Segment(text, self._style(style)) for text, style in self._lines[y] if text]
        return Strip(pieces).adjust_cell_length(width, self._base)

    def _style(self, name: str) -> Style:
        if name not in self._named:
            own = "" if name.startswith("#") and not self._in_colour else name
            self._named[name] = self._base + Style.parse(own)
        return self._named[name]


def _colour(value: int) -> Color:
    return Color.from_rgb(value >> 16, value >> 8 & 255, value & 255)
