"""Figures as data: a report says what to draw, not how.

``course.figures.drawing.plots`` draws them; nothing here imports matplotlib.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike

__all__ = ["Kind", "Panel", "Plot", "Series"]

Kind = Literal["line", "steps", "points", "band", "interval", "bars", "level"]


@dataclass(frozen=True)
class Series:
    """One curve, or anything else with its own name in the legend.

    Attributes:
        name: in the legend; "" leaves it out.
        x: (n,) numbers, or n words for categories. Of a "level" (a line across the panel) empty.
        y: (n,); the lower edge of a "band"; the value of an "interval"; one number for a "level".
        kind: how it is drawn. "interval" is a point with an error bar from ``low`` to ``high``.
        low, high: (n,); ends of intervals. A band needs ``high`` only.
        quiet: drawn thin and grey, as a reference.
    """

    name: str
    x: ArrayLike | Sequence[str]
    y: ArrayLike
    kind: Kind = "line"
    low: ArrayLike | None = None
    high: ArrayLike | None = None
    quiet: bool = False


@dataclass(frozen=True)
class Panel:
    """One pair of axes.

    Attributes:
        x_label, y_label: quantity and unit, like "time / s".
        log: which axes are logarithmic.
        equal: one metre is as long in both directions (for maps).
    """

    x_label: str
    y_label: str
    series: tuple[Series, ...]
    title: str = ""
    log: Literal["", "x", "y", "xy"] = ""
    equal: bool = False


@dataclass(frozen=True)
class Plot:
    """A figure: one or more panels side by side or below each other.

    Attributes:
        title: what it shows, as a sentence.
        description: what the figure shows, in words, for a reader who cannot see it.
        columns: how many panels stand in a row.
    """

    title: str
    panels: tuple[Panel, ...]
    description: str = ""
    columns: int = 1
    height_in: float = field(default=0.0)
