"""A picture in half blocks: two pixels a cell, the upper as its ink and the lower as its paper."""

from __future__ import annotations

from typing import Any

from rich.color import Color
from rich.style import Style
from rich.text import Text

__all__ = ["half_blocks"]


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
    colours: dict[bytes, Color] = {}

    def colour(at: int) -> Color:
        three = pixels[at : at + 3]
        if three not in colours:
            colours[three] = Color.from_rgb(*three)
        return colours[three]

    lines = []
    for row in range(rows):
        line = Text(no_wrap=True)
        for column in range(columns):
            upper = 3 * (2 * row * columns + column)
            lower = upper + 3 * columns
            letter = letters.get((row, column))
            if letter is None:
                line.append("▀", Style(color=colour(upper), bgcolor=colour(lower)))
            else:
                words, ink, bold = letter
                paper = [(pixels[upper + part] + pixels[lower + part]) // 2 for part in range(3)]
                line.append(
                    words, Style(color=Color.from_rgb(*ink), bgcolor=Color.from_rgb(*paper), bold=bold)
                )
        lines.append(line)
    return lines
