"""The outcome of checks as a notebook shows it: a table, with the same words as in a terminal."""

from __future__ import annotations

import re
from dataclasses import replace
from html import escape
from typing import TYPE_CHECKING

from course.scoring.numbers import format_points, numbers_of

if TYPE_CHECKING:
    from collections.abc import Mapping

    from course.figures.drawing.curves import Curve
    from course.notebooks.page import ReportPage
    from course.scoring.verdict import CheckResult, Verdict

__all__ = ["CheckTable"]

_MOST = 6  # lines of what was printed
_MARKS = {"pass": "✓", "skip": "–"}
_STYLE = (
    "<style>.course-checks{border-collapse:collapse}.course-checks td{text-align:left!important;"
    "vertical-align:top;padding:.35em .6em}.course-checks td:first-child{white-space:nowrap}"
    ".course-checks small{opacity:.8}</style>"
)


class CheckTable:
    """Checks and what they found; Jupyter shows it as a table, a plain terminal as lines.

    Args:
        verdict: on all public checks.
        task: show those of this function only; None shows all.
        note: another sentence to show.
        printed: what the code printed while it was loaded.
        scored: points are shown; a warm-up has none.
        curves: by id of a failed check, the student's curve and the right one; the first is drawn.

    Attributes:
        report: what the code does on public data, shown below; None if there is none.
    """

    def __init__(
        self,
        verdict: Verdict,
        task: str | None,
        note: str = "",
        *,
        printed: str = "",
        scored: bool = True,
        curves: Mapping[str, Curve] | None = None,
    ) -> None:
        self.report: ReportPage | None = None
        self._printed = _first_lines(printed)
        self._scored = scored
        self.verdict = verdict
        self.note = note
        self.checks = tuple(check for check in verdict.checks if task in (None, check.task))
        self._task = task
        self._curve = next((curves[check.id] for check in self.checks if curves and check.id in curves), None)

    @property
    def passed(self) -> bool:
        """Whether all shown checks pass."""
        return bool(self.checks) and all(check.status == "pass" for check in self.checks)

    @property
    def summary(self) -> str:
        """The outcome in a sentence."""
        if self.verdict.state != "graded":
            problem = self.verdict.error
            return f"{problem.message} {problem.help}" if problem else "Nothing could be checked."
        passing = sum(check.status == "pass" for check in self.checks)
        points = sum(check.points for check in self.checks)
        most = sum(check.max_points for check in self.checks)
        of = f" of {self._task}" if self._task else ""
        score = f": {format_points(points)} of {format_points(most)} points" if self._scored else ""
        if self.passed and len(self.checks) == 1:
            return f"The one public check{of} passes{score}."
        if self.passed:
            return f"All {len(self.checks)} public checks{of} pass{score}."
        return f"{passing} of {len(self.checks)} public checks{of} pass{score}."

    def __repr__(self) -> str:
        lines = [*self._printed]
        curve = self._curve.description if self._curve is not None else ""
        report = repr(self.report) if self.report is not None else ""
        below = [text for text in (curve, *self.verdict.warnings, self.note, report) if text]
        for check in self.checks:
            lines.append(f"{_MARKS.get(check.status, '✗')} {check.title}: {check.status}")
            lines += [f"    {text}" for text in _words(check)]
        return "\n".join([*lines, self.summary, *below])

    def _repr_html_(self) -> str:
        rows = "".join(_row(check, scored=self._scored) for check in self.checks)
        table = f'<table class="course-checks">{rows}</table>' if rows else ""
        notes = [note for note in (*self.verdict.warnings, self.note) if note]
        note = "".join(f"<p>{_coded(text)}</p>" for text in notes)
        printed = f"<pre>{escape(chr(10).join(self._printed))}</pre>" if self._printed else ""
        report = self.report._repr_html_() if self.report is not None else ""
        return f"{_STYLE}{printed}{table}<p><b>{escape(self.summary)}</b></p>{self._drawn()}{note}{report}"

    def _drawn(self) -> str:
        """The first curve, and where it leaves the right one."""
        if self._curve is None:
            return ""
        from course.figures.drawing.curves import plot_of
        from course.notebooks.page import image_of

        # The words stand below the picture; a screen reader must not read them twice.
        image = image_of(replace(plot_of(self._curve), description="Your curve over the right one."))
        return f"{image}<p><small>{escape(self._curve.description)}</small></p>"


def _row(check: CheckResult, *, scored: bool) -> str:
    mark = _MARKS.get(check.status, "✗")
    words = "".join(
        f"<br>{_coded(text)}" if index < 2 else f"<br><small>{escape(text)}</small>"
        for index, text in enumerate(_words(check))
    )
    points = f"<td>{format_points(check.points)}/{format_points(check.max_points)}</td>" if scored else ""
    return (
        f"<tr><td>{mark} {escape(str(check.status))}</td>"
        f"<td><b>{escape(check.title)}</b>{words}</td>{points}</tr>"
    )


def _coded(text: str) -> str:
    """Words as HTML, with code marked as code."""
    return re.sub(r"`([^`]+)`", r"<code>\1</code>", escape(text))


def _words(check: CheckResult) -> list[str]:
    """Message, advice, then numbers, where there are any."""
    if check.status == "pass":
        return []
    lines = [text for text in (check.message, check.help) if text]
    lines += [f"{label}: {text}" for label, text in numbers_of(check)]
    printed = _first_lines(check.stdout or "")
    return [*lines, "your code printed:", *printed] if printed else lines


def _first_lines(text: str) -> list[str]:
    """The first printed lines, and how many more there are."""
    lines = text.rstrip().splitlines()
    left = len(lines) - _MOST
    return [*lines[:_MOST], f"and {left} more"] if left > 0 else lines
