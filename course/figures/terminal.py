"""A figure at the size of a terminal: pixels for half blocks, and its words as letters of the terminal.

A cell holds two pixels, so a whole figure has few of them and none to spare for letters. Curves are one pixel
wide, and every text is taken out and returned with the cell it belongs to. Texts that would lie on others are
left out, ticks before titles.

``python -m course.figures.terminal`` draws for a program that keeps matplotlib out of its own memory: one
JSON request a line on standard input, one JSON answer a line on standard output.
"""

import base64
import io
import json
import re
import sys
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import Collection
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.text import Text
from numpy.typing import NDArray
from PIL import Image

from course.errors import CourseError
from course.figures.described import plot_of, read_curve
from course.figures.plots import draw
from course.figures.registry import build, png
from course.figures.style import house_style

#: A line of this many points on paper is one pixel here.
_PAPER_PT = 1.3
#: A marker is drawn this many pixels wide.
_MARKER_PX = 2.0
#: In a panel lower than this, ring markers of that width would fill up: there they are a pixel.
_LOW_PANEL_PX = 24.0
_LETTER_PX = 2.0
_LEAST_ROWS = 8
#: Letters with less contrast to the drawing below them get plain paper; the limit is WCAG 2.1's for text.
_CONTRAST = 4.5
_MATHS = re.compile(r"\\mathdefault\{([^}]*)\}|\\(?:mathrm|text)\{([^}]*)\}")
_RAISED = str.maketrans("0123456789-−+", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻⁻⁺")
_SIGNS = {"omega": "ω", "mu": "μ", "times": "×", "Delta": "Δ", "pi": "π", "theta": "θ"}
_LOWERED = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")


@dataclass(frozen=True, slots=True)
class Label:
    """A text of the figure, and the cell it begins in.

    Attributes:
        ink: its colour, as red, green and blue from 0 to 255.
        bold: it heads the figure or a part of it.
    """

    column: int
    row: int
    text: str
    ink: tuple[int, int, int]
    bold: bool


@dataclass(frozen=True, slots=True)
class TerminalFigure:
    """A figure of so many cells.

    Attributes:
        pixels: red, green and blue of each pixel, shape (2 * rows, columns, 3).
    """

    columns: int
    rows: int
    pixels: np.ndarray[Any, np.dtype[np.uint8]]
    labels: tuple[Label, ...]


def in_cells(make: Callable[[], Figure], columns: int, rows: int = 0) -> TerminalFigure:
    """Draw any figure for so many cells.

    Args:
        make: draws the figure; called in the house style.
        rows: 0 for as many as the figure's own shape asks for, cells being twice as high as wide.
    """
    with house_style():
        figure = make()
        rows = rows or max(_LEAST_ROWS, round(columns * figure.get_figheight() / figure.get_figwidth() / 2))
        width = float(figure.get_figwidth())
        dpi = columns / width
        figure.set_dpi(dpi)
        figure.set_size_inches(width, 2 * rows / dpi)
        # Letters of two pixels are as wide as a cell, and their exponents are still a size that fonts have.
        size = _LETTER_PX * 72.0 / dpi
        for text in figure.findobj(Text):
            text.set_fontsize(size)
        for axes in figure.axes:
            axes.tick_params(which="both", labelsize=size)
        canvas: Any = FigureCanvasAgg(figure)
        figure.draw_without_rendering()  # it lays everything out
        labels = _labels(figure, canvas, columns, rows)
        _thicken(figure, 72.0 / dpi)
        canvas.draw()
    pixels = np.asarray(canvas.buffer_rgba())[: 2 * rows, :columns, :3]
    whole = np.full((2 * rows, columns, 3), 255, dtype=np.uint8)
    whole[: pixels.shape[0], : pixels.shape[1]] = pixels
    for label in labels:
        _clear(whole, label)
    return TerminalFigure(columns, rows, whole, tuple(labels))


def _clear(pixels: np.ndarray[Any, np.dtype[np.uint8]], label: Label) -> None:
    """Plain paper under a label that could not be read on the drawing."""
    under = pixels[2 * label.row : 2 * label.row + 2, label.column : label.column + len(label.text)]
    ink = _luminance(np.array(label.ink))
    papers = _luminance(under.mean(axis=0))
    contrast = (np.maximum(ink, papers) + 0.05) / (np.minimum(ink, papers) + 0.05)
    letters = np.array([letter != " " for letter in label.text])
    if (contrast[letters] < _CONTRAST).any():
        under[:] = 255 if ink < 0.5 else 0


def _luminance(colour: Any) -> Any:
    """Relative luminance of sRGB colours from 0 to 255, shape (..., 3), as WCAG 2.1 defines it."""
    share = np.asarray(colour) / 255.0
    linear = np.where(share <= 0.03928, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)
    return linear @ np.array([0.2126, 0.7152, 0.0722])


def _thicken(figure: Figure, pixel: float) -> None:
    """Make lines and markers visible; ``pixel`` is one pixel in points."""
    for line in figure.findobj(Line2D):
        line.set_linewidth(max(0.6, line.get_linewidth() / _PAPER_PT) * pixel)
        low = line.axes is not None and line.axes.bbox.height < _LOW_PANEL_PX
        line.set_markersize((1.0 if low else _MARKER_PX) * pixel)
        line.set_markeredgewidth(0.5 * pixel)
    for axes in figure.axes:
        for spine in axes.spines.values():
            spine.set_linewidth(0.5 * pixel)
        axes.tick_params(which="both", length=0.0)
        for grid in (*axes.get_xgridlines(), *axes.get_ygridlines()):
            grid.set_linewidth(0.5 * pixel)
            grid.set_markersize(0.0)
    for artist in figure.findobj(Collection):
        artist.set_linewidth(0.8 * pixel)
    patch: Any
    for patch in figure.findobj(Patch):
        if patch.get_linewidth() and patch.get_edgecolor()[3] > 0.0:
            patch.set_linewidth(0.5 * pixel)


def _labels(figure: Figure, canvas: Any, columns: int, rows: int) -> list[Label]:
    """Every text with the cell it begins in; the texts are removed from the figure."""
    renderer: Any = canvas.get_renderer()
    suptitle = getattr(figure, "_suptitle", None)
    titles = {suptitle} | {getattr(axes, name) for axes in figure.axes for name in ("title", "_left_title")}
    names = {axis.label: axes for axes in figure.axes for axis in (axes.xaxis, axes.yaxis)}
    ticks = {
        label: axes
        for axes in figure.axes
        for axis in (axes.xaxis, axes.yaxis)
        for label in axis.get_ticklabels(which="both")
    }
    found: list[tuple[int, Label]] = []
    for text in figure.findobj(Text):
        words = _plain(text.get_text())
        if not words.strip() or not text.get_visible():
            continue
        box = text.get_window_extent(renderer)
        text.set_alpha(0.0)
        if text in ticks and not _is_beside(ticks[text], box, renderer):
            continue
        box_patch = text.get_bbox_patch()
        if box_patch is not None:
            box_patch.set_visible(False)
        middle = rows - (box.y0 + box.y1) / 4.0
        ink = tuple(round(255 * part) for part in to_rgb(text.get_color()))
        rank = 0 if text is suptitle else 1 if text in titles else 3 if text in ticks else 2
        lines = words.splitlines()
        wide = text.get_rotation() % 180 > 45
        for number, line in enumerate(lines):
            row = round(middle - len(lines) / 2 + number)
            if rank == 0:
                column, row = 0, number
            elif wide and text in names:
                # The name of an upright axis lies over its upper end.
                bounds = names[text].get_window_extent(renderer)
                column, row = round(bounds.x0) + 1, round(rows - bounds.y1 / 2.0)
            elif text in ticks and text.get_horizontalalignment() == "right":
                column = round(box.x1) - len(line)
            elif text.get_horizontalalignment() == "left":
                column = round(box.x0)
            else:
                column = round((box.x0 + box.x1 - len(line)) / 2)
            column = max(0, min(column, columns - len(line)))
            if text in names:  # the name of an axis at the edge may lie half a row beyond it
                row = max(0, min(row, rows - 1))
            found.append((rank, Label(column, row, line[:columns], ink, rank < 2)))  # type: ignore[arg-type]
    return _apart(found, rows)


def _is_beside(axes: Axes, box: Any, renderer: Any) -> bool:
    """Whether a tick's label stands beside its axis: those beyond its ends are never drawn."""
    bounds = axes.get_window_extent(renderer)
    x, y = (box.x0 + box.x1) / 2, (box.y0 + box.y1) / 2
    return bool(bounds.x0 - 1 <= x <= bounds.x1 + 1 or bounds.y0 - 1 <= y <= bounds.y1 + 1)


def _apart(found: list[tuple[int, Label]], rows: int) -> list[Label]:
    """The texts that overlap no other, more important ones first; a text may move up or down a row."""
    taken: set[tuple[int, int]] = set()
    kept: list[Label] = []
    for rank, label in sorted(found, key=lambda one: one[0]):
        moves = (0,) if rank == 3 else (0, 1, -1, 2)
        for move in moves:
            row = label.row + move
            cells = {(row, column) for column in range(label.column - 1, label.column + len(label.text) + 1)}
            if 0 <= row < rows and not cells & taken:
                taken |= cells
                kept.append(Label(label.column, row, label.text, label.ink, label.bold))
                break
    return kept


def _plain(text: str) -> str:
    """A text's words, with mathematics in letters that a terminal has."""
    text = _MATHS.sub(lambda m: m[1] or m[2] or "", text)
    text = re.sub(r"\^\{([^}]*)\}|\^(\w)", lambda m: (m[1] or m[2]).translate(_RAISED), text)
    text = re.sub(r"_\{([^}]*)\}|_(\w)", lambda m: (m[1] or m[2]).translate(_LOWERED), text)
    for name, sign in _SIGNS.items():
        text = text.replace(f"\\{name}", sign)
    return text.replace("$", "").replace("\\", "").replace("{", "").replace("}", "")


def _answer(request: dict[str, Any]) -> dict[str, Any]:
    if request.get("png"):
        return {"png": base64.b64encode(png(request["figure"])).decode("ascii")}
    size = request["columns"], request["rows"]
    if "curve" in request:
        plot = plot_of(read_curve(request["curve"]))
        figure = in_cells(lambda: draw(plot), *size)
    else:
        figure = in_cells(lambda: build(request["figure"]), *size)
    return {
        "pixels": base64.b64encode(figure.pixels.tobytes()).decode("ascii"),
        "labels": [[one.column, one.row, one.text, one.ink, one.bold] for one in figure.labels],
    }


def _serve() -> None:
    for line in sys.stdin:
        request = json.loads(line)
        try:
            answer = _answer(request)
        except CourseError as error:
            answer = {"error": error.message}
        sys.stdout.write(json.dumps({**answer, "id": request["id"]}) + "\n")
        sys.stdout.flush()


# ---
# A picture as sixels: six rows of pixels a line of letters, one pass for each colour.
#
# Source: Digital Equipment Corporation, *VT330/VT340 Programmer Reference Manual*, volume 2, chapter 14
# ("Sixel Graphics").


#: A VT340 has 16 colours; the terminals of today that speak sixel have at least 256.
_COLOURS = 255


def sixels(png: bytes, width: int) -> str:
    """The characters that make a terminal show a picture.

    Args:
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


if __name__ == "__main__":
    _serve()
