"""A score set by an instructor, with a reason: it replaces the graders', now and after any regrading."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from course.errors import NotFoundError, UsageError
from course.grading.gradebook.records import Override
from course.printable import command
from course.scoring.numbers import format_points

if TYPE_CHECKING:
    from course.grading.results.effective import Effective, Results

__all__ = ["lift", "override"]

_MAX_REASON = 2000


def override(results: Results, student: str, exercise: str, score: float, reason: str) -> Effective:
    """Set a score and store the reason; earlier decisions stay in the gradebook.

    Args:
        results: over a gradebook opened for writing.
        score: points, from 0 to the exercise's maximum.

    Raises:
        NotFoundError: the gradebook knows no such student or exercise.
        UsageError: no such score is possible, or there is no reason.
    """
    most = _maximum(results, student, exercise)
    if not math.isfinite(score) or not 0 <= score <= most:
        raise UsageError(
            f"--score is {score:g}; {exercise} has 0 to {most:g} points.",
            help="Give the points that are to count.",
            code="impossible_score",
        )
    reason = reason.strip()
    if not reason or len(reason) > _MAX_REASON:
        raise UsageError(
            "An override needs a reason of at most 2000 characters.",
            help="Add --reason: it is shown wherever the score is.",
            code="no_reason",
        )
    before = _told(next(results.all(student, exercise), None))
    results.book.add_override(Override(student, exercise, float(score), reason), before)
    return _now_counts(results, student, exercise)


def lift(results: Results, student: str, exercise: str, reason: str) -> Effective | None:
    """Let the graders' result count again; None if there is none.

    Raises:
        NotFoundError: there is no override to lift.
    """
    _maximum(results, student, exercise)
    found = next((item for item in results.all(student, exercise)), None)
    if found is None or found.override is None:
        explain = command("grade", "explain", results.folder, student, exercise)
        raise NotFoundError(
            f"There is no override for {student!r} and {exercise}.",
            help=f"{explain} shows what counts.",
            code="no_override",
        )
    results.book.add_override(Override(student, exercise, None, reason.strip()), _told(found))
    return next(type(results)(results.book).all(student, exercise), None)


def _told(counts: Effective | None) -> str:
    """The score that counted, for the journal."""
    if counts is None or counts.score is None:
        return "no score"
    by = f"by hand: {counts.override.reason}" if counts.override else counts.verdict.state
    return f"{format_points(counts.score)}, {by}"


def _now_counts(results: Results, student: str, exercise: str) -> Effective:
    return next(type(results)(results.book).all(student, exercise))


def _maximum(results: Results, student: str, exercise: str) -> float:
    """The exercise's maximum; also checks that student and exercise exist."""
    graded = next(iter(results.book.results(student, exercise)), None)
    noted = next((item for item in results.exercises() if item.id == exercise), None)
    if graded is None and noted is None:
        raise NotFoundError(
            f"The gradebook has no exercise {exercise!r}.",
            help=f"It has {', '.join(item.id for item in results.exercises()) or 'none'}.",
            code="exercise_not_found",
        )
    if student not in results.students():
        raise NotFoundError(
            f"The gradebook has no student {student!r}.",
            help="grades.csv lists all, and with a roster everybody who is enrolled.",
            code="student_not_found",
        )
    if noted is not None:
        return noted.max_points
    assert graded is not None
    return graded.verdict.max_score
