"""The files that ``course sim`` writes: a table and a figure."""

from __future__ import annotations

import csv
import io
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from course.figures.registry import Builder
    from course.simulations.base import Result

__all__ = ["builder", "figure", "table"]


def table(result: Result) -> bytes:
    """The series of a run as CSV: a line of names with units, then every sample, every digit."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(f"{column.name} [{column.unit}]" for column in result.columns)
    for row in zip(*(column.values.tolist() for column in result.columns), strict=True):
        writer.writerow(map(repr, row))
    return text.getvalue().encode()


def figure(result: Result, kind: str) -> bytes:
    """The figure of a run as a PNG, SVG or PDF file; the same run gives the same bytes."""
    from course.figures.experiments.basic import render

    return render(result, kind)


def builder(result: Result) -> Builder:
    """Draws the figure of a run, for a screen."""

    def make() -> Any:
        from course.figures.experiments.basic import draw

        return draw(result)

    return make
