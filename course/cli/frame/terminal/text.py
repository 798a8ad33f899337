"""Text on its way to a terminal: made harmless, wrapped between words, styled."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING

from course.printable import steady, unheeded

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rich.text import Text

__all__ = ["Piece", "bare", "filled", "harmless", "rich_text"]

Piece = str | tuple[str, str]


def filled(row: str, width: int, margin: str = "", hanging: int = 0) -> str:
    """One row as several, broken between words only."""
    wrapper = textwrap.TextWrapper(width, margin, margin + " " * hanging)
    wrapper.break_long_words = wrapper.break_on_hyphens = False
    return wrapper.fill(row)


def bare(piece: Piece) -> str:
    """A piece without its style."""
    return harmless(piece if isinstance(piece, str) else piece[0])


def rich_text(pieces: Sequence[Piece]) -> Text:
    """Pieces as one Rich text."""
    from rich.text import Text

    text = Text()
    for piece in pieces:
        text.append(bare(piece), None if isinstance(piece, str) else piece[1])
    return text


def harmless(text: str) -> str:
    """Text without control codes or workflow commands: a student's own text is shown, never obeyed."""
    return unheeded(steady(text.replace("\r\n", "\n")))
