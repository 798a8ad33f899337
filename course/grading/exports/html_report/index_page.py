"""The list of students: the number of each student's page, and all scores. For the instructor."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from course.grading.exports.html_report.rendering import render

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from course.grading.gradebook.records import GradedExercise
    from course.grading.results.effective import Effective, Results
    from course.grading.results.roster import Person

__all__ = ["IndexRow", "index_page", "index_row"]


@dataclass(frozen=True, slots=True)
class IndexRow:
    """One student: number of the page, and for each exercise the points and anything unusual."""

    student: str
    place: int
    href: str
    person: Person | None
    scores: tuple[tuple[float | None, str] | None, ...]


def index_row(
    results: Results,
    student: str,
    place: int,
    href: str,
    found: Mapping[str, Effective],
    exercises: Sequence[str],
) -> IndexRow:
    """One student.

    Args:
        found: exercise -> result.
        exercises: the columns.
    """
    scores = tuple(_score(found.get(exercise)) for exercise in exercises)
    return IndexRow(student, place, href, results.person(student), scores)


def _score(effective: Effective | None) -> tuple[float | None, str] | None:
    if effective is None:
        return None
    remarks = []
    if effective.override is not None:
        remarks.append("by hand")
    elif effective.missing:
        remarks.append("missing")
    elif effective.waiting:
        remarks.append("not graded yet")
    elif effective.score is None:
        remarks.append("fault of the grader")
    elif effective.verdict.state != "graded":
        remarks.append("not graded")
    elif not effective.passed:
        remarks.append("not passed")
    if effective.late is not None:
        remarks.append("late")
    return effective.score, ", ".join(remarks)


def index_page(
    results: Results, rows: Sequence[IndexRow], exercises: Sequence[GradedExercise], report: str
) -> str:
    """The whole page.

    Args:
        rows: in order.
        exercises: the columns.
        report: address of the page about the class.
    """
    return render(
        "students",
        scripted=True,
        course=f"{results.course.id} {results.course.version}".strip(),
        rows=rows,
        exercises=exercises,
        roster=results.roster is not None,
        report=report,
    )
