"""Maps places in the world to cells and pixels of a terminal.

A cell is twice as high as wide and shows two pixels, one above the other, so pixels are square. Pixel (0, 0)
is the upper left one, x goes right and y goes down; its centre is at (0.5, 0.5).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from course.sandbox.world.ledger import Floats

__all__ = ["Camera"]


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
