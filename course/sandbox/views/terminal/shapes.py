"""Bodies as pixels: how much of each pixel a body covers.

Bodies of one kind and about one size are computed together: a hundred balls cost as much as a few. A pixel's
cover follows from the distance of its centre to the outline: exact enough for edges that look smooth.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from collections.abc import Sequence

    from course.sandbox.scene.parts import Part
    from course.sandbox.views.terminal.camera import Camera
    from course.sandbox.world.ledger import Floats

__all__ = ["Group", "Stamp", "grouped", "reaches"]

Ints = NDArray[np.int64]

#: Half of the thinnest wall that is drawn, and the radius of the smallest ball, in pixels. Anything thinner
#: or smaller is drawn this large, or it would fade away between pixels.
_THINNEST, _SMALLEST = 0.55, 0.8
#: Steps of cover: fewer make fewer different colours to send, more make smoother edges.
_SHADES = 6
#: Farther out than this, in pixels, is the same as out of sight.
_FAR = 1e5


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
        shape: "circle", "polygon" or "segment".
        radius: in pixels, (m,); the outline is grown by it.
        normals, offsets: of a polygon's sides, outward, in the body's frame, (m, k, 2) and (m, k) in pixels.
        ends: of segments, in pixels, (m, 2, 2).
    """

    rows: Ints
    window: int
    shape: str
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
        if self.shape == "circle":
            return np.asarray(np.sqrt(dx * dx + dy * dy) - grown)
        c, s = np.cos(angle), np.sin(angle)
        if self.shape == "segment":
            return self._to_segment(dx, dy, c[:, None, None], s[:, None, None]) - grown
        nx, ny = self.normals[..., 0], self.normals[..., 1]
        # Pixels count downward, so the turned normal's y changes its sign.
        across, down = c[:, None] * nx - s[:, None] * ny, -(s[:, None] * nx + c[:, None] * ny)
        sides = across[..., None, None] * dx[:, None] + down[..., None, None] * dy[:, None]
        return np.asarray((sides - self.offsets[..., None, None]).max(axis=1) - grown)

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
    sorts: dict[tuple[str, int, int], list[int]] = {}
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


def _group(shape: str, window: int, rows: list[int], parts: Sequence[Part], scale: float) -> Group:
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
