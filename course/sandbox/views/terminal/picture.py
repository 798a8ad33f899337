"""A frame of the world as cells: a character, the colour of its ink and the colour of its paper.

In colour each cell is two pixels, drawn as a half block. Without colour each cell is a character for its
content: nothing is ever shown by colour alone.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import assert_never

import numpy as np
from numpy.typing import NDArray

from course.sandbox.scene.model import Form, Part
from course.sandbox.world.engine import Floats
from course.sandbox.world.world import Snapshot

# ---
# Bodies as pixels: how much of each pixel a body covers.
#
# Bodies of one kind and about one size are computed together: a hundred balls cost as much as a few. A
# pixel's cover follows from the distance of its centre to the outline: exact enough for edges that look
# smooth.


Ints = NDArray[np.int64]

#: Half of the thinnest wall that is drawn, and the radius of the smallest ball, in pixels. Anything thinner
#: or smaller is drawn this large, or it would fade away between pixels.
_THINNEST, _SMALLEST = 0.55, 0.8
#: Steps of cover: fewer make fewer different colours to send, more make smoother edges.
_SHADES = 6


@dataclass(frozen=True, slots=True)
class Stamp:
    """Covered pixels, one entry for each body and pixel; all (k,).

    Attributes:
        where: index into the flattened picture.
        cover: above 0, up to 1.
        part: the body, as an index into the world's parts.
    """

    where: Ints
    cover: Floats
    part: Ints


@dataclass(frozen=True, slots=True)
class Group:
    """Bodies that are computed together.

    Attributes:
        rows: which of the world's parts, (m,).
        window: side of the square of pixels that holds any of them.
        radius: in pixels, (m,); the outline is grown by it.
        normals, offsets: of a polygon's sides, outward, in the body's frame, (m, k, 2) and (m, k) in pixels.
        ends: of segments, in pixels, (m, 2, 2).
    """

    rows: Ints
    window: int
    shape: Form
    radius: Floats
    normals: Floats
    offsets: Floats
    ends: Floats

    def stamp(self, camera: Camera, x: Floats, y: Floats, angle: Floats) -> Stamp:
        """Which pixels these bodies cover.

        Args:
            x, y, angle: of all of the world's parts, in m and rad.
        """
        cx, cy = camera.pixels(x[self.rows], y[self.rows])
        cx, cy = (np.nan_to_num(np.clip(c, -_FAR, _FAR), nan=-_FAR) for c in (cx, cy))
        side = np.arange(self.window)
        px = np.floor(cx - self.window / 2 + 0.5).astype(np.int64)[:, None] + side
        py = np.floor(cy - self.window / 2 + 0.5).astype(np.int64)[:, None] + side
        dx, dy = px + 0.5 - cx[:, None], py + 0.5 - cy[:, None]
        distance = self._distance(dx[:, None, :], dy[:, :, None], angle[self.rows])
        cover = np.rint(np.clip(0.5 - distance, 0.0, 1.0) * _SHADES)
        body, down, across = np.nonzero(cover)
        gx, gy = px[body, across], py[body, down]
        inside = (gx >= 0) & (gx < camera.columns) & (gy >= 0) & (gy < 2 * camera.rows)
        shade = (cover[body, down, across] / _SHADES)[inside]
        # Where two of a group overlap, the one that covers more is painted last.
        order = np.argsort(shade, kind="stable")
        where = (gy * camera.columns + gx)[inside]
        return Stamp(where[order], shade[order], self.rows[body][inside][order])

    def _distance(self, dx: Floats, dy: Floats, angle: Floats) -> Floats:
        """From each pixel to the outline, in pixels; below 0 inside. (m, window, window)."""
        grown = self.radius[:, None, None]
        c, s = np.cos(angle), np.sin(angle)
        match self.shape:
            case "circle":
                return np.asarray(np.sqrt(dx * dx + dy * dy) - grown)
            case "segment":
                return self._to_segment(dx, dy, c[:, None, None], s[:, None, None]) - grown
            case "polygon":
                nx, ny = self.normals[..., 0], self.normals[..., 1]
                # Pixels count downward, so the turned normal's y changes its sign.
                across, down = c[:, None] * nx - s[:, None] * ny, -(s[:, None] * nx + c[:, None] * ny)
                sides = across[..., None, None] * dx[:, None] + down[..., None, None] * dy[:, None]
                return np.asarray((sides - self.offsets[..., None, None]).max(axis=1) - grown)
            case _:
                assert_never(self.shape)

    def _to_segment(self, dx: Floats, dy: Floats, c: Floats, s: Floats) -> Floats:
        bx, by = c * dx - s * dy, -s * dx - c * dy
        ax, ay = (self.ends[:, 0, i, None, None] for i in (0, 1))
        ex, ey = (self.ends[:, 1, i, None, None] - self.ends[:, 0, i, None, None] for i in (0, 1))
        length = np.maximum(ex * ex + ey * ey, 1e-12)
        along = np.clip(((bx - ax) * ex + (by - ay) * ey) / length, 0.0, 1.0)
        return np.asarray(np.hypot(bx - ax - along * ex, by - ay - along * ey))


def reaches(parts: Sequence[Part]) -> Floats:
    """The radius of the circle around each body that holds it, (n,), in m."""
    far = [max((math.hypot(*corner) for corner in part.outline), default=0.0) for part in parts]
    return np.array([reach + part.radius for reach, part in zip(far, parts, strict=True)], dtype=float)


def grouped(parts: Sequence[Part], camera: Camera, *, fixed: bool) -> tuple[Group, ...]:
    """The bodies that move, or those that do not, in groups.

    Args:
        parts: all of the world's.
        fixed: which of the two.
    """
    sizes = reaches(parts) * camera.scale
    sorts: dict[tuple[Form, int, int], list[int]] = {}
    for i, part in enumerate(parts):
        if part.fixed is fixed:
            key = part.shape, len(part.outline), _window(sizes[i])
            sorts.setdefault(key, []).append(i)
    return tuple(_group(key[0], key[2], rows, parts, camera.scale) for key, rows in sorts.items())


def _window(reach: float) -> int:
    """The side of a square that holds a body of this size; of few sizes, so that groups are large."""
    needed = 2 * max(reach, _SMALLEST) + 3
    side = 4
    while side < needed:
        side += side // 2
    return side


def _group(shape: Form, window: int, rows: list[int], parts: Sequence[Part], scale: float) -> Group:
    chosen = [parts[i] for i in rows]
    radius = np.array([part.radius * scale for part in chosen])
    normals, offsets = np.zeros((len(rows), 0, 2)), np.zeros((len(rows), 0))
    ends = np.zeros((len(rows), 2, 2))
    if shape == "polygon":
        normals, offsets = _sides(np.array([part.outline for part in chosen]) * scale)
        radius += np.maximum(0.0, _THINNEST - offsets.min(axis=1))
    else:
        radius = np.maximum(radius, _SMALLEST if shape == "circle" else _THINNEST)
    if shape == "segment":
        ends = np.array([part.outline for part in chosen]) * scale
    return Group(np.array(rows), window, shape, radius, normals, offsets, ends)


def _sides(corners: Floats) -> tuple[Floats, Floats]:
    """Outward normals of counter-clockwise corners, (m, k, 2), and how far out each side is, (m, k)."""
    along = np.roll(corners, -1, axis=1) - corners
    normals = np.stack([along[..., 1], -along[..., 0]], axis=-1)
    normals /= np.maximum(np.linalg.norm(normals, axis=-1, keepdims=True), 1e-12)
    return normals, np.asarray((normals * corners).sum(axis=-1))


Codes = NDArray[np.uint32]

PAPER = 0x12161C
_INK = 0xE8ECF1
_ROD = 0x6F7782
_HAND = 0xFFC857
_SPARK = np.array([255.0, 244.0, 214.0])
_HALF, _SPACE = ord("▀"), ord(" ")
#: The characters used without colour.
_GLYPHS: dict[Form, str] = {"circle": "o", "polygon": "#", "segment": "="}
_FIXED, _LINE, _BURST, _POINTER = "▒", "·", "*", "+"
_ARROWS = "→↗↑↖←↙↓↘"
#: A body gets its label inside if it is at least this wide, in pixels; smaller ones when names are asked for.
_ROOM = 3.5
#: Farther out than this, in pixels, is the same as out of sight.
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
    _still: Floats | None = field(default=None, init=False)

    def __post_init__(self) -> None:
        self._groups = grouped(self.parts, self.camera, fixed=False)
        self._fixed = grouped(self.parts, self.camera, fixed=True)
        self._paints = np.array([_paint(part) for part in self.parts]).reshape(-1, 3)
        self._reach = reaches(self.parts) * self.camera.scale
        self._names = [label_of(part.name) for part in self.parts]
        glyphs = [_FIXED if part.fixed else _GLYPHS[part.shape] for part in self.parts]
        self._glyphs = np.array(
            [_SPACE, *map(ord, glyphs), ord(_LINE), ord(_LINE), ord(_BURST)], dtype=np.uint32
        )
        # Of two things in one cell the moving one is shown; rods lie behind it, hands and flashes in front.
        self._rank = np.array([0, *(1 if part.fixed else 3 for part in self.parts), 2, 4, 5])
        self._marked = np.flatnonzero(
            [
                (part.shape == "circle" and reach >= _TURNS and not part.fixed) or part.wheels is not None
                for part, reach in zip(self.parts, self._reach, strict=True)
            ]
        )
        self._scale = _scale(self.camera)
        self._free = [i for i, part in enumerate(self.parts) if not part.fixed]

    def draw(self, shot: Snapshot, over: Overlay) -> Cells:
        """A frame.

        Args:
            shot: of the same parts.
        """
        return self._in_colour(shot, over) if self.colour else self._in_characters(shot, over)

    # -- colour ----------------------------------------------------------------------------------

    def _in_colour(self, shot: Snapshot, over: Overlay) -> Cells:
        camera = self.camera
        if self._still is None:
            self._still = np.tile(_rgb(PAPER), (2 * camera.rows * camera.columns, 1))
            self._paint_groups(self._still, self._fixed, shot)
        pixels = self._still.copy()
        pixels[self._dotted(over)] = _rgb(_ROD)
        for joint in shot.joints:
            self._line(pixels, joint, _rgb(_ROD))
        self._paint_groups(pixels, self._groups, shot)
        self._mark(pixels, shot)
        for spark in over.sparks:
            self._flash(pixels, spark)
        for pull in filter(None, (shot.hand, over.pull)):
            self._line(pixels, pull, _rgb(_HAND))
        packed = (pixels.astype(np.uint32) @ np.array([65536, 256, 1], dtype=np.uint32)).reshape(
            2 * camera.rows, camera.columns
        )
        upper, lower = packed[0::2], packed[1::2]
        same = upper == lower
        char = np.where(same, _SPACE, _HALF).astype(np.uint32)
        cells = Cells(char, np.where(same, 0, upper).astype(np.uint32), lower.copy())
        self._label(cells, shot, over)
        return cells

    def _paint_groups(self, pixels: Floats, groups: Iterable[Group], shot: Snapshot) -> None:
        for group in groups:
            stamp = group.stamp(self.camera, shot.x, shot.y, shot.angle)
            cover = stamp.cover[:, None]
            pixels[stamp.where] = pixels[stamp.where] * (1 - cover) + self._paints[stamp.part] * cover

    def _line(self, pixels: Floats, ends: Sequence[float] | Floats, paint: Floats) -> None:
        pixels[self._along(ends)] = paint

    def _along(self, ends: Sequence[float] | Floats) -> NDArray[np.int64]:
        """The pixels of a line in the world, as indices into the flattened picture."""
        camera = self.camera
        both = np.asarray(ends, dtype=float).reshape(2, 2)
        x, y = camera.pixels(both[:, 0], both[:, 1])
        if not np.isfinite([x, y]).all():
            return np.zeros(0, dtype=np.int64)
        x, y = np.clip(x, -_FAR, _FAR), np.clip(y, -_FAR, _FAR)
        count = min(4000, int(max(abs(x[1] - x[0]), abs(y[1] - y[0]))) + 2)
        px = np.floor(np.linspace(x[0], x[1], count)).astype(np.int64)
        py = np.floor(np.linspace(y[0], y[1], count)).astype(np.int64)
        inside = (px >= 0) & (px < camera.columns) & (py >= 0) & (py < 2 * camera.rows)
        return np.asarray((py * camera.columns + px)[inside])

    def _dotted(self, over: Overlay) -> NDArray[np.int64]:
        camera = self.camera
        x, y = camera.pixels(over.dots[:, 0], over.dots[:, 1])
        inside = (x >= 0) & (x < camera.columns) & (y >= 0) & (y < 2 * camera.rows)
        return np.asarray(y[inside].astype(np.int64) * camera.columns + x[inside].astype(np.int64))

    def _mark(self, pixels: Floats, shot: Snapshot) -> None:
        """A dark spot that shows how far a ball has turned, a light one at the front of what drives."""
        rows = self._marked
        if not len(rows):
            return
        out = 0.62 * self._reach[rows] / self.camera.scale
        x, y = shot.x[rows] + out * np.cos(shot.angle[rows]), shot.y[rows] + out * np.sin(shot.angle[rows])
        for row, ax, ay in zip(rows, x, y, strict=True):
            # Two pixels for the large, one for the small.
            ends = (ax, ay, ax - (ax - shot.x[row]) * (0.4 if self._reach[row] > 5 else 0.0), ay)
            drives = self.parts[row].wheels is not None
            self._line(pixels, ends, _rgb(_INK) if drives else self._paints[row] * 0.45)

    def _flash(self, pixels: Floats, spark: Spark) -> None:
        camera = self.camera
        px, py = (spark.x - camera.left) * camera.scale, (camera.top - spark.y) * camera.scale
        if not (-2 < px < camera.columns + 2 and -2 < py < 2 * camera.rows + 2):
            return
        beside = 0.55 if spark.glow > 0.5 else 0.0
        for dx, dy, share in ((0, 0, 1.0), (1, 0, beside), (-1, 0, beside), (0, 1, beside), (0, -1, beside)):
            x, y = math.floor(px) + dx, math.floor(py) + dy
            if 0 <= x < camera.columns and 0 <= y < 2 * camera.rows:
                glow = round(spark.glow * share * 6) / 6
                at = y * camera.columns + x
                pixels[at] = pixels[at] * (1 - glow) + _SPARK * glow

    # -- characters ------------------------------------------------------------------------------

    def _in_characters(self, shot: Snapshot, over: Overlay) -> Cells:
        camera = self.camera
        what = np.zeros(2 * camera.rows * camera.columns, dtype=np.int64)
        rods, lines, bursts = (len(self.parts) + i for i in (1, 2, 3))
        what[self._dotted(over)] = bursts
        for joint in shot.joints:
            what[self._along(joint)] = rods
        for group in (*self._fixed, *self._groups):
            stamp = group.stamp(camera, shot.x, shot.y, shot.angle)
            solid = stamp.cover > 0.4
            what[stamp.where[solid]] = stamp.part[solid] + 1
        for spark in over.sparks:
            what[self._along((spark.x, spark.y, spark.x, spark.y))] = bursts
        for pull in filter(None, (shot.hand, over.pull)):
            what[self._along(pull)] = lines
        halves = what.reshape(camera.rows, 2, camera.columns)
        rank = self._rank[halves]
        chosen = np.where(rank[:, 0] >= rank[:, 1], halves[:, 0], halves[:, 1])
        char = self._glyphs[chosen]
        blank = np.zeros_like(char)
        cells = Cells(char, blank, blank.copy())
        self._label(cells, shot, over)
        return cells

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


def _rgb(colour: int) -> Floats:
    return np.array([colour >> 16, colour >> 8 & 255, colour & 255], dtype=float)


def _paint(part: Part) -> Floats:
    """A body's colour on a dark background: a little lighter than on white; fixed bodies are dimmer."""
    own = _rgb(int(part.colour.lstrip("#"), 16))
    return own * 0.62 if part.fixed else own * 0.85 + 255 * 0.15


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
