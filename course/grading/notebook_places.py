"""Lines of the module that a notebook stands for, told as cells: what a student looks for."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import TYPE_CHECKING

import msgspec

if TYPE_CHECKING:
    from course.catalog.models import Exercise
    from course.grading.notebook_source import NotebookSource
    from course.grading.report import Report
    from course.grading.verdict import Verdict

__all__ = ["in_cells", "placed", "placed_report"]


def in_cells(text: str, module: NotebookSource, exercise: Exercise) -> str:
    """Words about a notebook's module, with cells in place of its lines."""

    def word(match: re.Match[str]) -> str:
        place = module.place(int(match[1] or match[2]))
        return place[:1].upper() + place[1:] if match[1] else f"in {place} of your notebook"

    name = re.escape(exercise.module)
    return re.sub(rf"{name}, line (\d+)|on line (\d+) of your file", word, text)


def placed(verdict: Verdict, module: NotebookSource, exercise: Exercise) -> Verdict:
    """The verdict on a notebook's module with cells in place of its lines, and the notes as warnings."""
    in_traces = re.compile(rf"^{re.escape(exercise.module)}:(\d+) in ", re.MULTILINE)

    def words(text: str) -> str:
        return in_cells(text, module, exercise)

    def trace(text: str | None) -> str | None:
        return text and in_traces.sub(lambda match: f"{module.place(int(match[1]))} in ", text)

    checks = tuple(
        msgspec.structs.replace(check, message=words(check.message), traceback=trace(check.traceback))
        for check in verdict.checks
    )
    error = verdict.error
    if error is not None:
        error = msgspec.structs.replace(error, message=words(error.message))
    warnings = (*verdict.warnings, *(note for note in module.notes if note not in verdict.warnings))
    return msgspec.structs.replace(verdict, checks=checks, error=error, warnings=warnings)


def placed_report(report: Report, module: NotebookSource, exercise: Exercise) -> Report:
    """The report on a notebook's module with cells in place of its lines."""
    sections = tuple(
        replace(section, text=in_cells(section.text, module, exercise)) for section in report.sections
    )
    return replace(report, sections=sections)
