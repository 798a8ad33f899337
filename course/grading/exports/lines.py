"""The instructor's two plain exports: ``results.jsonl`` with everything, ``grades.csv`` with the scores."""

from __future__ import annotations

import csv
import io
from typing import TYPE_CHECKING

import msgspec

from course.grading.verdict import CheckResult, Problem, finite

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from course.grading.gradebook import Result

__all__ = ["CourseRef", "GradeLine", "grade_line", "safe_cell", "write_csv", "write_jsonl"]

#: A spreadsheet takes a cell that begins with one of these for a formula.
_FORMULA = ("=", "+", "-", "@", "\t", "\r", "\n")
_COLUMNS = ("student", "exercise", "score", "max_score", "passed", "state", "reason", "late_s", "isolation")


class CourseRef(msgspec.Struct, frozen=True):
    """Which course a result is about."""

    id: str
    version: str


class GradeLine(msgspec.Struct, frozen=True, kw_only=True, tag="course.grade/1", tag_field="schema"):
    """One student and exercise: the body of ``course.check/1``, and what a grading run adds to it."""

    ok: bool
    exit_code: int
    course: CourseRef
    student: str
    exercise: str
    scope: str
    state: str
    score: float
    max_score: float
    passed: bool
    checks: tuple[CheckResult, ...]
    error: Problem | None = None
    submission_sha256: str
    grader_version: str
    seed: int
    isolation: str
    late: float | None = None
    graded_at: str = ""
    warnings: tuple[str, ...] = ()


def grade_line(result: Result, course: CourseRef) -> GradeLine:
    """A result as its line of JSON."""
    verdict, key = result.verdict, result.key
    codes = {"ungradable": 3, "grader_error": 70}
    return GradeLine(
        ok=verdict.all_pass,
        exit_code=codes.get(verdict.state, 0 if verdict.all_pass else 1),
        course=course,
        student=key.student,
        exercise=key.exercise,
        scope=verdict.scope,
        state=verdict.state,
        score=verdict.score,
        max_score=verdict.max_score,
        passed=verdict.passed,
        checks=verdict.checks,
        error=verdict.error,
        submission_sha256=key.submission_sha256,
        grader_version=key.grader_version,
        seed=key.seed,
        isolation=verdict.isolation,
        late=result.late,
        graded_at=result.graded_at,
        warnings=verdict.warnings,
    )


def write_jsonl(path: Path, results: Iterable[Result], course: CourseRef) -> None:
    """One line per student and exercise, everything in it: for the instructor only."""
    with path.open("wb") as handle:
        for result in results:
            handle.write(msgspec.json.encode(finite(msgspec.to_builtins(grade_line(result, course)))) + b"\n")


def write_csv(path: Path, results: Iterable[Result]) -> None:
    """One row per student and exercise; every cell quoted, none of them a formula."""
    text = io.StringIO(newline="")
    writer = csv.writer(text, quoting=csv.QUOTE_ALL, lineterminator="\r\n")
    writer.writerow(_COLUMNS)
    for result in results:
        verdict = result.verdict
        late = "" if result.late is None else f"{result.late:.0f}"
        reason = verdict.error.code if verdict.error else ""
        score, most = f"{verdict.score:g}", f"{verdict.max_score:g}"
        passed = "yes" if verdict.passed else "no"
        cells = (result.key.student, result.key.exercise, score, most, passed, verdict.state, reason, late)
        writer.writerow([safe_cell(cell) for cell in (*cells, verdict.isolation)])
    path.write_bytes(b"\xef\xbb\xbf" + text.getvalue().encode("utf-8"))  # the mark makes Excel read UTF-8


def safe_cell(text: str) -> str:
    """A cell that a spreadsheet shows as it is: formulas are disarmed, control characters are escaped."""
    shown = "".join(
        character if character.isprintable() else character.encode("unicode_escape").decode("ascii")
        for character in text
    )
    return "'" + shown if text.startswith(_FORMULA) else shown
