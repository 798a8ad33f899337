"""Pictures inside a terminal, where the terminal can: the kitty and the iTerm2 protocols, or half blocks.

Which terminal it is can only be told from its environment; asking it would mean reading its answer from the
keyboard. When in doubt the picture is made of half blocks, which need colours and letters beyond ASCII only;
a wrong guess of a protocol fills the screen with letters.

Sources: kitty's "Terminal graphics protocol"; iTerm2's "Inline Images Protocol" (both read November 2026).
"""

from __future__ import annotations

import base64
from typing import TYPE_CHECKING, Literal

from rich.console import Group
from rich.segment import ControlType, Segment

from course.cli.frame.half_blocks import half_blocks

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from rich.console import Console, ConsoleOptions, RenderableType

    from course.figures.registry import Builder

__all__ = ["InlinePicture", "Protocol", "picture", "protocol_of"]

Protocol = Literal["kitty", "iterm2"]

#: The kitty protocol takes at most this many bytes of base64 at a time.
_CHUNK = 4096


def protocol_of(console: Console, environ: Mapping[str, str]) -> Protocol | None:
    """How the terminal behind a console shows pictures; None if it does not, or nobody knows.

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
    return None


class InlinePicture:
    """A PNG that Rich can print.

    Args:
        png: the file's bytes.
        protocol: how to say it.
        columns: width on the screen; the height follows.
    """

    def __init__(self, png: bytes, protocol: Protocol, columns: int) -> None:
        self._png = png
        self._protocol = protocol
        self._columns = columns

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> Iterator[Segment]:
        # A control segment has no width and is dropped where there is no terminal.
        yield Segment(self.escape_codes(), None, [(ControlType.HOME,)])
        yield Segment.line()

    def escape_codes(self) -> str:
        """What the terminal is to be sent."""
        data = base64.b64encode(self._png).decode("ascii")
        if self._protocol == "iterm2":
            size = f"size={len(self._png)};width={self._columns};preserveAspectRatio=1"
            return f"\x1b]1337;File=inline=1;{size}:{data}\x07"
        chunks = [data[start : start + _CHUNK] for start in range(0, len(data), _CHUNK)]
        codes = []
        for index, chunk in enumerate(chunks):
            # q=2: no answer, which would arrive as if it had been typed.
            head = f"a=T,f=100,q=2,c={self._columns}," if index == 0 else ""
            more = int(index < len(chunks) - 1)
            codes.append(f"\x1b_G{head}m={more};{chunk}\x1b\\")
        return "".join(codes)


def picture(
    console: Console, environ: Mapping[str, str], make: Builder, columns: int
) -> RenderableType | None:
    """A figure as this terminal can show it best; None if it cannot, and only words are left."""
    protocol = protocol_of(console, environ)
    if protocol is None and not _has_half_blocks(console):
        return None
    from course.figures.drawing.style import file_of
    from course.figures.terminal import in_cells

    if protocol is not None:
        return InlinePicture(file_of(make, "png"), protocol, columns)
    drawn = in_cells(make, columns)
    labels = [[one.column, one.row, one.text, one.ink, one.bold] for one in drawn.labels]
    return Group(*half_blocks(drawn.pixels.tobytes(), drawn.columns, drawn.rows, labels))


def _has_half_blocks(console: Console) -> bool:
    """Whether there are colours enough, and a letter that is half a block."""
    enough = console.is_terminal and not console.no_color and console.color_system in ("256", "truecolor")
    return enough and console.encoding.lower().replace("-", "").startswith("utf")
