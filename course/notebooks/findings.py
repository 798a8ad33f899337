"""The outcome of checks as a notebook shows it: a table, the same words as in a terminal."""

from __future__ import annotations

import re
from html import escape
from typing import TYPE_CHECKING

from course.scoring.numbers import format_points, numbers_of

if TYPE_CHECKING:
    from course.scoring.verdict import CheckResult, Verdict

__all__ = ["CheckTable"]

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
        note: what else there is to say, as a sentence.
    """

    def __init__(self, verdict: Verdict, task: str | None, note: str = "") -> None:
        self.verdict = verdict
        self.note = note
        self.checks = tuple(check for check in verdict.checks if task in (None, check.task))
        self._task = task

    @property
    def passed(self) -> bool:
        """Whether every check that is shown passes."""
        return bool(self.checks) and all(check.status == "pass" for check in self.checks)

    @property
    def summary(self) -> str:
        """What it comes to, in a sentence."""
        if self.verdict.state != "graded":
            problem = self.verdict.error
            return f"{problem.message} {problem.help}" if problem else "Nothing could be checked."
        passing = sum(check.status == "pass" for check in self.checks)
        points = sum(check.points for check in self.checks)
        most = sum(check.max_points for check in self.checks)
        of = f" of {self._task}" if self._task else ""
        score = f"{format_points(points)} of {format_points(most)} points"
        if self.passed and len(self.checks) == 1:
            return f"The one public check{of} passes: {score}."
        if self.passed:
            return f"All {len(self.checks)} public checks{of} pass: {score}."
        return f"{passing} of {len(self.checks)} public checks{of} pass: {score}."

    def __repr__(self) -> str:
        lines = []
        for check in self.checks:
            lines.append(f"{_MARKS.get(check.status, '✗')} {check.title}: {check.status}")
            lines += [f"    {text}" for text in _words(check)]
        return "\n".join([*lines, self.summary, *([self.note] if self.note else [])])

    def _repr_html_(self) -> str:
        rows = "".join(_row(check) for check in self.checks)
        table = f'<table class="course-checks">{rows}</table>' if rows else ""
        note = f"<p>{escape(self.note)}</p>" if self.note else ""
        return f"{_STYLE}{table}<p><b>{escape(self.summary)}</b></p>{note}"


def _row(check: CheckResult) -> str:
    mark = _MARKS.get(check.status, "✗")
    words = "".join(
        f"<br>{_coded(text)}" if index < 2 else f"<br><small>{escape(text)}</small>"
        for index, text in enumerate(_words(check))
    )
    return (
        f"<tr><td>{mark} {escape(str(check.status))}</td>"
        f"<td><b>{escape(check.title)}</b>{words}</td>"
        f"<td>{format_points(check.points)}/{format_points(check.max_points)}</td></tr>"
    )


def _coded(text: str) -> str:
    """Words as HTML, code in them as code."""
    return re.sub(r"`([^`]+)`", r"<code>\1</code>", escape(text))


def _words(check: CheckResult) -> list[str]:
    """Message, advice, then numbers, as far as there are any."""
    if check.status == "pass":
        return []
    lines = [text for text in (check.message, check.help) if text]
    lines += [f"{label}: {text}" for label, text in numbers_of(check)]
    return lines
