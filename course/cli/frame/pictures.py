"""Pictures inside a terminal, where the terminal can: kitty's and iTerm2's protocols, sixels, or half blocks.

The terminal's kind is known only from its environment: its answer to a question would arrive as if typed. In
doubt the picture is made of half blocks, which need only colours and letters beyond ASCII; a wrong guess of
the protocol would fill the screen with letters.

Sources: kitty's "Terminal graphics protocol"; iTerm2's "Inline Images Protocol" (both read November 2026);
for sixels, :mod:`course.figures.terminal`.
"""

from __future__ import annotations

import base64
import struct
from collections.abc import Iterator, Mapping
from functools import cache
from typing import TYPE_CHECKING, Any, Literal

from rich.cells import cell_len
from rich.color import Color
from rich.console import Console, ConsoleOptions, Group, RenderableType, RenderResult
from rich.segment import ControlType, Segment, Segments
from rich.style import Style
from rich.syntax import Syntax
from rich.text import Text

if TYPE_CHECKING:
    from course.figures.registry import Builder


# ---
# A picture in half blocks: two pixels a cell, the upper as its ink and the lower as its paper.


def half_blocks(pixels: bytes, columns: int, rows: int, labels: list[list[Any]]) -> list[Text]:
    """Pixels as half blocks, with letters over them.

    Args:
        pixels: red, green and blue, row by row, two rows a cell.
        labels: (column, row, text, (red, green, blue), bold) each.
    """
    letters = {
        (row, column + at): (letter, ink, bold)
        for column, row, words, ink, bold in labels
        for at, letter in enumerate(words)
    }
    colour = cache(lambda three: Color.from_rgb(*three))

    def cell(row: int, column: int) -> tuple[str, Style]:
        at, below = 3 * (2 * row * columns + column), 3 * columns
        upper, lower = pixels[at : at + 3], pixels[at + below : at + below + 3]
        if (row, column) not in letters:
            return "▀", Style(color=colour(upper), bgcolor=colour(lower))
        letter, ink, bold = letters[row, column]
        paper = bytes((one + other) // 2 for one, other in zip(upper, lower, strict=True))
        return letter, Style(color=Color.from_rgb(*ink), bgcolor=colour(paper), bold=bold)

    every = ([cell(row, column) for column in range(columns)] for row in range(rows))
    return [Text.assemble(*cells, no_wrap=True) for cells in every]


def in_half_blocks(make: Builder, columns: int, rows: int = 0) -> list[Text]:
    """A figure in half blocks; its height follows from its width unless it is given."""
    from course.figures.terminal import in_cells

    drawn = in_cells(make, columns, rows)
    labels = [[one.column, one.row, one.text, one.ink, one.bold] for one in drawn.labels]
    return half_blocks(drawn.pixels.tobytes(), drawn.columns, drawn.rows, labels)


Protocol = Literal["kitty", "iterm2", "sixel"]

#: Terminals that show sixels as they are installed. Others need a setting, which cannot be detected.
_SIXEL_TERMS = ("foot", "mlterm", "contour")

#: Pixels in a letter's width where the terminal does not say: those of the VT340 and its imitations.
_LETTER = 10

#: The kitty protocol takes at most this many bytes of base64 at a time.
_CHUNK = 4096


def protocol_of(console: Console, environ: Mapping[str, str]) -> Protocol | None:
    """How the terminal behind a console shows pictures; None if it does not, or if that is unknown.

    A multiplexer swallows or misplaces pictures unless it was set up for them, so inside one there are none.
    """
    if not console.is_terminal or environ.get("TERM") == "dumb":
        return None
    if environ.get("TMUX") or environ.get("STY") or environ.get("ZELLIJ"):
        return None
    program = environ.get("TERM_PROGRAM", "").lower()
    if environ.get("KITTY_WINDOW_ID") or environ.get("TERM") == "xterm-kitty" or program == "ghostty":
        return "kitty"
    if program in ("iterm.app", "wezterm") or environ.get("LC_TERMINAL") == "iTerm2":
        return "iterm2"
    konsole = environ.get("KONSOLE_VERSION", "")
    if environ.get("TERM", "").startswith(_SIXEL_TERMS) or (konsole.isdigit() and int(konsole) >= 220400):
        return "sixel"
    return None


def _escape_codes(png: bytes, protocol: Protocol, columns: int, console: Console) -> str:
    """The characters that have a terminal show a picture so many columns wide; the height follows."""
    if protocol == "sixel":
        from course.figures.terminal import sixels

        return sixels(png, columns * _letter_of(console))
    data = base64.b64encode(png).decode("ascii")
    if protocol == "iterm2":
        size = f"size={len(png)};width={columns};preserveAspectRatio=1"
        return f"\x1b]1337;File=inline=1;{size}:{data}\x07"
    chunks = [data[start : start + _CHUNK] for start in range(0, len(data), _CHUNK)]
    codes = []
    for index, chunk in enumerate(chunks):
        # q=2: no reply, which would arrive as if it had been typed.
        head = f"a=T,f=100,q=2,c={columns}," if index == 0 else ""
        more = int(index < len(chunks) - 1)
        codes.append(f"\x1b_G{head}m={more};{chunk}\x1b\\")
    return "".join(codes)


def picture(
    console: Console, environ: Mapping[str, str], make: Builder, columns: int
) -> RenderableType | None:
    """A figure as this terminal can show it best; None if it cannot, and only words are left."""
    protocol = protocol_of(console, environ)
    if protocol is None and not has_half_blocks(console):
        return None
    if protocol is None:
        return Group(*in_half_blocks(make, columns))
    from course.figures.style import file_of

    codes = _escape_codes(file_of(make, "png"), protocol, columns, console)
    # A control segment has no width and is dropped where there is no terminal.
    return Segments([Segment(codes, None, [(ControlType.HOME,)]), Segment.line()])


def _letter_of(console: Console) -> int:
    """Pixels in a letter's width, as the terminal reports it."""
    try:
        import fcntl
        import termios

        answer = fcntl.ioctl(console.file.fileno(), termios.TIOCGWINSZ, bytes(8))
    except (ImportError, OSError):  # not here, or no terminal
        return _LETTER
    _, columns, width, _ = struct.unpack("4H", answer)
    return max(1, width // columns) if width and columns else _LETTER


def has_half_blocks(console: Console) -> bool:
    """Whether there are enough colours, and the half-block letter."""
    enough = console.is_terminal and not console.no_color and console.color_system in ("256", "truecolor")
    return enough and console.encoding.lower().replace("-", "").startswith("utf")


# ---
# Code in a terminal: highlighted; a line longer than the window continues with a deeper indent.


#: Begins the rest of a line, two columns further in than the line: a statement begins with no such letter.
_GOES_ON = "↳ "
_FURTHER = 2
_LEAST = 12  # columns that are left for it, however far in the line begins


class Code:
    """Code to be printed with Rich."""

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
