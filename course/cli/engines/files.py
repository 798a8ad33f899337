"""The files that ``course engines compare`` writes, and its rows as data."""

from __future__ import annotations

import csv
import io
import math
from pathlib import Path  # noqa: TC003 - functions here take paths, and annotations are read
from typing import TYPE_CHECKING

from course.cli.engines.replies import EngineRow
from course.cli.frame.files import inserted

if TYPE_CHECKING:
    from course.engines.results import Comparison

__all__ = ["figures", "rows", "table"]

_COLUMNS = (
    "engine",
    "version",
    "scenario",
    "setting",
    "dt",
    "status",
    "value",
    "truth",
    "error",
    "unit",
    "best",
    "origin",
    "measured",
    "repeats",
    "spread",
    "message",
)


def rows(comparison: Comparison) -> tuple[EngineRow, ...]:
    """Every row with its truth, its error and whether it is the best of its column."""
    from course.cli.engines.screen import best_rows
    from course.engines.scenarios.scenario import SCENARIOS

    best = best_rows(comparison.rows)
    made = []
    for row in comparison.rows:
        scenario = SCENARIOS[row.scenario]
        made.append(
            EngineRow(
                engine=row.engine,
                scenario=row.scenario,
                setting=row.setting,
                dt=row.dt,
                status=row.status,
                value=row.value,
                truth=scenario.truth,
                error=None if row.value is None else scenario.error(row.value),
                unit=scenario.unit,
                best=id(row) in best,
                message=row.message,
                origin=row.origin,
                measured=row.measured,
                version=row.version,
                options=row.options,
                why=row.why,
                samples=row.samples,
                repeats=row.repeats,
                spread=row.spread,
                details=row.details,
            )
        )
    return tuple(made)


def table(comparison: Comparison) -> bytes:
    """All rows as CSV: a line of names, then every digit."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(_COLUMNS)
    for row in rows(comparison):
        writer.writerow(_plain(getattr(row, column)) for column in _COLUMNS)
    return text.getvalue().encode()


def _plain(value: object) -> str:
    if value is None:
        return ""
    if isinstance(value, float) and math.isinf(value):
        return "inf"
    return repr(value) if isinstance(value, float) else str(value)


def figures(comparison: Comparison, path: Path) -> list[tuple[Path, bytes]]:
    """The figures that can be drawn from the rows, each with the name of its file."""
    from course.figures.engine_comparison import render

    kind = path.suffix.lower().removeprefix(".")
    pictures = render(comparison.rows, kind)
    return [(inserted(path, name), data) for name, data in pictures.items()]
