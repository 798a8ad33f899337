"""Code in a terminal: highlighted; a line longer than the window continues with a deeper indent."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.cells import cell_len
from rich.syntax import Syntax
from rich.text import Text

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rich.console import Console, ConsoleOptions, RenderResult

__all__ = ["Code"]

#: Begins the rest of a line, two columns further in than the line: a statement begins with no such letter.
_GOES_ON = "↳ "
_FURTHER = 2
_LEAST = 12  # columns that are left for it, however far in the line begins


class Code:
    """Code to be printed with Rich.

    Args:
        source: the code.
        language: a name that Pygments knows.
    """

    def __init__(self, source: str, language: str = "python") -> None:
        self._source = source.rstrip("\n").expandtabs(4)
        self._highlighter = Syntax("", language, theme="ansi_dark", background_color="default")

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        shown = self._highlighter.highlight(self._source)
        shown.rstrip()
        for line in shown.split(allow_blank=True):
            yield from _rows(line, options.max_width)


def _rows(line: Text, width: int) -> Iterator[Text]:
    """A line of code in rows of this many columns at most; it breaks between words where it can."""
    plain = line.plain
    indent = len(plain) - len(plain.lstrip())
    margin = " " * max(0, min(indent + _FURTHER, width - _LEAST))
    start, head = 0, Text(end="")
    while True:
        end = _fitting(plain, start, width - head.cell_len, indent if start == 0 else start)
        row = Text.assemble(head, line[start:end], no_wrap=True)
        row.rstrip()
        yield row
        if end == len(plain):
            return
        start = end + (len(plain[end:]) - len(plain[end:].lstrip()))
        head = Text.assemble(margin, (_GOES_ON, "dim"))


def _fitting(plain: str, start: int, room: int, words_from: int) -> int:
    """The end of a row that begins at ``start`` and has this much room."""
    end = min(len(plain), start + max(1, room))
    while cell_len(plain[start:end]) > room and end > start + 1:  # some letters take two columns
        end -= 1
    if end == len(plain) or plain[end] == " ":
        return end
    space = plain.rfind(" ", words_from, end)
    return space + 1 if space > words_from else end
