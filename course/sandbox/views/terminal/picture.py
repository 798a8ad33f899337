"""A frame of the world as cells: a character, the colour of its ink and the colour of its paper.

In colour each cell is two pixels, drawn as a half block. Without colour each cell is a character for its
content: nothing is ever shown by colour alone.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from course.sandbox.runs.recording import draw_body
from course.sandbox.scene.model import Form, Part
from course.sandbox.world.engine import Floats
from course.sandbox.world.world import Snapshot

#: Everything is drawn this many times as large: PIL draws hard edges, and scaling down makes them smooth.
_FINE = 4
#: Half of the thinnest wall that is drawn, and the radius of the smallest ball, in pixels. Anything thinner
#: or smaller is drawn this large, or it would fade away between pixels.
_THINNEST, _SMALLEST = 0.55, 0.8


def reaches(parts: Sequence[Part]) -> Floats:
    """The radius of the circle around each body that holds it, (n,), in m."""
    far = [max((math.hypot(*corner) for corner in part.outline), default=0.0) for part in parts]
    return np.array([reach + part.radius for reach, part in zip(far, parts, strict=True)], dtype=float)


def _grown(part: Part, scale: float) -> float:
    """By how many pixels a body's outline is grown: its radius, and what it lacks to be seen."""
    if part.shape == "polygon":
        sides = zip(part.outline, [*part.outline[1:], part.outline[0]], strict=True)
        inner = min(abs(ax * by - ay * bx) / math.dist((ax, ay), (bx, by)) for (ax, ay), (bx, by) in sides)
        return max(0.0, _THINNEST - inner * scale)
    return max(part.radius * scale, _SMALLEST if part.shape == "circle" else _THINNEST)


Codes = NDArray[np.uint32]

PAPER = 0x12161C
_INK = 0xE8ECF1
_ROD = 0x6F7782
_HAND = 0xFFC857
_SPARK = 0xFFF4D6
_HALF, _SPACE = ord("▀"), ord(" ")
#: The characters used without colour.
_GLYPHS: dict[Form, str] = {"circle": "o", "polygon": "#", "segment": "="}
_FIXED, _LINE, _BURST, _POINTER = "▒", "·", "*", "+"
_ARROWS = "→↗↑↖←↙↓↘"
#: A body gets its label inside if it is at least this wide, in pixels; smaller ones when names are asked for.
_ROOM = 3.5
#: Farther out than this, in pixels of the large picture, is the same as out of sight.
_FAR = 1e5
#: Smallest radius, in pixels, at which a mark shows that a ball turns.
_TURNS = 2.6


@dataclass(frozen=True, slots=True)
class Spark:
    """A contact that flashes: where, in m, and how bright it still is, 0 to 1."""

    x: float
    y: float
    glow: float


@dataclass(frozen=True, slots=True)
class Overlay:
    """The overlay on the world.

    Attributes:
        pointer: the keyboard's pointer, in m.
        pull: a line from something held or aimed to where it is pulled, in m: ax, ay, bx, by.
        sparks: contacts of the last moments.
        names: label bodies however small they are.
        dots: places that are marked: a path, a run before; (k, 2), in m.
    """

    pointer: tuple[float, float] | None = None
    pull: tuple[float, float, float, float] | None = None
    sparks: tuple[Spark, ...] = ()
    names: bool = False
    dots: Floats = field(default_factory=lambda: np.zeros((0, 2)))


@dataclass(frozen=True, slots=True)
class Cells:
    """A frame, each array (rows, columns): a code point, and two colours as 0xRRGGBB."""

    char: Codes
    ink: Codes
    paper: Codes

    def changes(self, other: Cells | None) -> list[tuple[int, int, int]]:
        """Rows in which two frames differ: row, first column, number of columns."""
        if other is None or other.char.shape != self.char.shape:
            return [(row, 0, self.char.shape[1]) for row in range(self.char.shape[0])]
        differs = (self.char != other.char) | (self.ink != other.ink) | (self.paper != other.paper)
        rows = np.flatnonzero(differs.any(axis=1))
        first = differs[rows].argmax(axis=1)
        last = differs.shape[1] - differs[rows, ::-1].argmax(axis=1)
        return [(int(r), int(a), int(b - a)) for r, a, b in zip(rows, first, last, strict=True)]


@dataclass
class Picture:
    """Draws one set of bodies through one camera; make a new one when either changes.

    Args:
        parts: all of the world's.
        colour: half blocks in colour, or characters.
    """

    parts: tuple[Part, ...]
    camera: Camera
    colour: bool = True
    _still: Image.Image | None = field(default=None, init=False)

    def __post_init__(self) -> None:
        self._reach = reaches(self.parts) * self.camera.scale
        self._grown = [_FINE * _grown(part, self.camera.scale) for part in self.parts]
        self._names = [label_of(part.name) for part in self.parts]
        glyphs = [_FIXED if part.fixed else _GLYPHS[part.shape] for part in self.parts]
        self._glyphs = np.array(
            [_SPACE, *map(ord, glyphs), ord(_LINE), ord(_LINE), ord(_BURST)], dtype=np.uint32
        )
        # Of two things in one cell the moving one is shown; rods lie behind it, hands and flashes in front.
        self._rank = np.array([0, *(1 if part.fixed else 3 for part in self.parts), 2, 4, 5])
        #: Of paper, each body, rods, hands and flashes: colours, or places in the two lists above.
        self._inks: list[Any] = list(range(len(self._glyphs)))
        if self.colour:
            bodies = [_paint(part) for part in self.parts]
            self._inks = [_rgb(PAPER), *bodies, *map(_rgb, (_ROD, _HAND, _SPARK))]
        self._scale = _scale(self.camera)
        self._free = [i for i, part in enumerate(self.parts) if not part.fixed]

    def draw(self, shot: Snapshot, over: Overlay) -> Cells:
        """A frame.

        Args:
            shot: of the same parts.
        """
        if self._still is None:  # what does not move
            size = _FINE * self.camera.columns, _FINE * 2 * self.camera.rows
            self._still = Image.new("RGB" if self.colour else "I", size, self._inks[0])
            self._draw_bodies(ImageDraw.Draw(self._still), shot, fixed=True)
        image = self._still.copy()
        pen = ImageDraw.Draw(image)
        rod, hand, flash = self._inks[-3:]
        for x, y in self._fine(*over.dots.T):
            pen.rectangle(_square(x, y, 1), fill=rod if self.colour else flash)
        for joint in shot.joints:
            self._draw_line(pen, joint, rod)
        self._draw_bodies(pen, shot, fixed=False)
        for spark in over.sparks:
            self._draw_flash(image, spark)
        for pull in filter(None, (shot.hand, over.pull)):
            self._draw_line(pen, pull, hand)
        cells = self._in_colour(image) if self.colour else self._in_characters(image)
        self._label(cells, shot, over)
        return cells

    # -- the large picture -----------------------------------------------------------------------

    def _fine(self, x: Floats, y: Floats) -> list[tuple[float, float]]:
        """Places in pixels of the large picture."""
        both = np.array(self.camera.pixels(x, y)) * _FINE
        return [(px, py) for px, py in np.nan_to_num(both, nan=_FAR).clip(-_FAR, _FAR).T.tolist()]

    def _draw_bodies(self, pen: ImageDraw.ImageDraw, shot: Snapshot, *, fixed: bool) -> None:
        scale, places = _FINE * self.camera.scale, self._fine(shot.x, shot.y)
        angles = np.nan_to_num(shot.angle).tolist()
        for row, part in enumerate(self.parts):
            if part.fixed is not fixed:
                continue
            (x, y), angle = places[row], angles[row]
            c, s = scale * math.cos(angle), scale * math.sin(angle)
            corners = [(x + c * px - s * py, y - s * px - c * py) for px, py in part.outline]
            draw_body(pen, part.shape, corners, (x, y), self._grown[row], fill=self._inks[1 + row])
            turns = part.shape == "circle" and self._reach[row] >= _TURNS
            if self.colour and not fixed and (turns or part.wheels is not None):
                self._mark(pen, row, x, y, angle)

    def _mark(self, pen: ImageDraw.ImageDraw, row: int, x: float, y: float, angle: float) -> None:
        """A dark spot that shows how far a ball has turned, a light one at the front of what drives."""
        reach = self._reach[row]
        out = 0.62 * _FINE * reach
        spot = _square(x + out * math.cos(angle), y - out * math.sin(angle), 2 if reach > 5 else 1)
        dark = tuple(int(0.45 * value) for value in self._inks[1 + row])
        pen.rectangle(spot, fill=_rgb(_INK) if self.parts[row].wheels else dark)

    def _draw_line(self, pen: ImageDraw.ImageDraw, ends: Sequence[float] | Floats, ink: Any) -> None:
        places = np.asarray(ends, dtype=float).reshape(2, 2)
        if np.isfinite(places).all():
            pen.line(self._fine(*places.T), fill=ink, width=_FINE)

    def _draw_flash(self, image: Image.Image, spark: Spark) -> None:
        ((x, y),) = self._fine(np.array([spark.x]), np.array([spark.y]))
        if not self.colour:
            ImageDraw.Draw(image).rectangle(_square(x, y, 1), fill=self._inks[-1])
            return
        pen = ImageDraw.Draw(image, "RGBA")  # which lets what is below shine through
        for wide, share in ((3, 0.55), (1, 1.0)) if spark.glow > 0.5 else ((1, 1.0),):
            pen.ellipse(_square(x, y, wide), fill=(*self._inks[-1], round(255 * share * spark.glow)))

    # -- as cells --------------------------------------------------------------------------------

    def _in_colour(self, image: Image.Image) -> Cells:
        pixels = np.asarray(image.reduce(_FINE)).astype(np.uint32)
        packed = pixels @ np.array([65536, 256, 1], dtype=np.uint32)
        upper, lower = packed[0::2], packed[1::2]
        same = upper == lower
        char = np.where(same, _SPACE, _HALF).astype(np.uint32)
        return Cells(char, np.where(same, 0, upper).astype(np.uint32), lower.copy())

    def _in_characters(self, image: Image.Image) -> Cells:
        # What is in the middle of each pixel.
        what = np.asarray(image)[_FINE // 2 :: _FINE, _FINE // 2 :: _FINE]
        halves = what.reshape(self.camera.rows, 2, self.camera.columns)
        rank = self._rank[halves]
        char = self._glyphs[np.where(rank[:, 0] >= rank[:, 1], halves[:, 0], halves[:, 1])]
        return Cells(char, np.zeros_like(char), np.zeros_like(char))

    # -- both ------------------------------------------------------------------------------------

    def _label(self, cells: Cells, shot: Snapshot, over: Overlay) -> None:
        """A scale, a letter or number on each body that has room for it, and the pointer."""
        for column, letter in enumerate(self._scale, 1):
            line = self.camera.rows - 1
            if cells.char[line, column] == _SPACE and cells.paper[line, column] in {0, PAPER}:
                self._write(cells, column, line, letter, _ROD)
        for row in self._free:
            part = self.parts[row]
            if not over.names and 2 * self._reach[row] < _ROOM:
                continue
            x, y = float(shot.x[row]), float(shot.y[row])
            if not (math.isfinite(x) and math.isfinite(y)):
                continue
            column, line = self.camera.cell(x, y)
            text = self._names[row]
            text = text if 2 * self._reach[row] >= len(text) + 2 else text[-1:]
            if part.wheels is not None and not self.colour:
                text = _ARROWS[round(float(shot.angle[row]) / (math.pi / 4)) % 8]
            for i, letter in enumerate(text, column - len(text) // 2):
                self._write(cells, i, line, letter, None)
        if over.pointer is not None:
            self._write(cells, *self.camera.cell(*over.pointer), _POINTER, _HAND)

    def _write(self, cells: Cells, column: int, row: int, letter: str, ink: int | None) -> None:
        if not (0 <= column < self.camera.columns and 0 <= row < self.camera.rows):
            return
        if self.colour:
            paper = int(cells.paper[row, column])
            if ink is None:
                light = 0.3 * (paper >> 16) + 0.59 * (paper >> 8 & 255) + 0.11 * (paper & 255)
                ink = 0x0B0D10 if light > 95 else _INK
            cells.ink[row, column] = ink
        cells.char[row, column] = ord(letter)


def _scale(camera: Camera) -> str:
    """A line as long as a round length, with that length on it; "" where there is no room for one."""
    longest = min(24, camera.columns // 3)
    if longest < 6 or camera.rows < 6:
        return ""
    ten = 10.0 ** math.floor(math.log10(longest / camera.scale))
    length = next(ten * times for times in (5, 2, 1) if round(ten * times * camera.scale) <= longest)
    text = f" {length:g} m "
    return f"├{text:─^{max(0, round(length * camera.scale) - 2)}}┤"


def label_of(name: str) -> str:
    """The number at the end of a body's name, else its first letter: "12", "l"."""
    last = name.rpartition("-")[2]
    return last if last.isdigit() else name[:1]


def _rgb(colour: int) -> tuple[int, ...]:
    return colour >> 16, colour >> 8 & 255, colour & 255


def _paint(part: Part) -> tuple[int, ...]:
    """A body's colour on a dark background: a little lighter than on white; fixed bodies are dimmer."""
    own = _rgb(int(part.colour.lstrip("#"), 16))
    return tuple(int(0.62 * value if part.fixed else 0.85 * value + 255 * 0.15) for value in own)


def _square(x: float, y: float, wide: int) -> tuple[float, float, float, float]:
    """So many whole pixels of the small picture, with the place of the large one in their middle."""
    left, top = x // _FINE - wide // 2, y // _FINE - wide // 2
    return _FINE * left, _FINE * top, _FINE * (left + wide) - 1, _FINE * (top + wide) - 1


# ---
# Maps places in the world to cells and pixels of a terminal.
#
# A cell is twice as high as wide and shows two pixels, one above the other, so pixels are square. Pixel (0,
# 0) is the upper left one, x goes right and y goes down; its centre is at (0.5, 0.5).


@dataclass(frozen=True, slots=True)
class Camera:
    """A window onto the world.

    Attributes:
        left, top: the place at the upper left corner, in m.
        scale: pixels per metre.
        columns, rows: of cells.
    """

    left: float
    top: float
    scale: float
    columns: int
    rows: int

    @classmethod
    def fit(cls, view: tuple[float, float, float, float], columns: int, rows: int) -> Camera:
        """All of a view in the middle of a window.

        Args:
            view: left, bottom, right, top, in m.
            columns, rows: of the window, in cells; at least one each.
        """
        left, bottom, right, top = view
        columns, rows = max(1, columns), max(1, rows)
        scale = min(columns / (right - left), 2 * rows / (top - bottom))
        return cls(
            left=(left + right - columns / scale) / 2,
            top=(bottom + top + 2 * rows / scale) / 2,
            scale=scale,
            columns=columns,
            rows=rows,
        )

    def pixels(self, x: Floats, y: Floats) -> tuple[Floats, Floats]:
        """Places in pixels of places in m; both (n,)."""
        return (x - self.left) * self.scale, (self.top - y) * self.scale

    def cell(self, x: float, y: float) -> tuple[int, int]:
        """Column and row of the cell that shows a place; both may lie outside of the window."""
        return int((x - self.left) * self.scale // 1), int((self.top - y) * self.scale // 2)

    def place(self, column: int, row: int) -> tuple[float, float]:
        """The place in the middle of a cell, in m."""
        return self.left + (column + 0.5) / self.scale, self.top - (2 * row + 1) / self.scale
