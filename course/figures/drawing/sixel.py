"""A picture as sixels: six rows of pixels a line of letters, one pass for each colour.

Source: Digital Equipment Corporation, *VT330/VT340 Programmer Reference Manual*, volume 2, chapter 14
("Sixel Graphics").
"""

from __future__ import annotations

import io
from typing import TYPE_CHECKING

import numpy as np
from PIL import Image

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["sixels"]

#: A VT340 has 16 colours; the terminals of today that speak sixel have at least 256.
_COLOURS = 255


def sixels(png: bytes, width: int) -> str:
    """The characters that make a terminal show a picture.

    Args:
        png: the file's bytes.
        width: in pixels; the height follows.
    """
    with Image.open(io.BytesIO(png)) as opened:
        image = opened.convert("RGB")
    image = image.resize((width, max(1, round(image.height * width / image.width))), Image.Resampling.LANCZOS)
    reduced = image.quantize(_COLOURS, dither=Image.Dither.NONE)
    pixels = np.asarray(reduced)
    palette = np.asarray(reduced.getpalette()).reshape(-1, 3)
    # Colours are said in percent.
    colours = "".join(
        f"#{number};2;{red};{green};{blue}"
        for number, (red, green, blue) in enumerate(np.rint(palette * (100 / 255)).astype(int))
    )
    bands = "-".join(_band(pixels[top : top + 6]) for top in range(0, len(pixels), 6))
    # P2 = 1: pixels that are not named stay as they are. 1;1 are square pixels.
    return f'\x1bP0;1;0q"1;1;{width};{len(pixels)}{colours}{bands}\x1b\\'


def _band(rows: NDArray[np.uint8]) -> str:
    """Up to six rows of pixels: for each colour, a letter a column whose bits are the rows that have it."""
    weights = 1 << np.arange(len(rows))
    return "$".join(f"#{colour}{_run_lengths(weights @ (rows == colour))}" for colour in np.unique(rows))


def _run_lengths(bits: NDArray[np.int64]) -> str:
    """Letters, with runs as ``!count letter``."""
    ends = np.append(np.flatnonzero(np.diff(bits)), len(bits) - 1)
    counts = np.diff(ends, prepend=-1)
    letters = [chr(63 + value) for value in bits[ends]]
    return "".join(
        f"!{count}{letter}" if count > 3 else letter * count
        for count, letter in zip(counts, letters, strict=True)
    )
