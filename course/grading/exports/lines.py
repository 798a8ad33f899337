"""The instructor's two plain exports: ``results.jsonl`` with everything, ``grades.csv`` with the scores."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

import msgspec

from course.catalog.models import CourseRef
from course.grading.exports.cells import csv_bytes, number, replacing, safe_cell, write_bytes
from course.grading.results.effective import NOT_YET
from course.scoring.verdict import CheckResult, Problem, finite

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from course.grading.results.effective import Effective, Results

__all__ = ["GradeLine", "OverrideLine", "grade_line", "safe_cell", "write_csv", "write_jsonl"]

_COLUMNS = (
    "student", "exercise", "score", "max_score", "passed", "state", "reason", "late_s", "isolation",
    "raw_score", "late_penalty", "override_reason", "submitted_at", "graded_at",
)  # fmt: skip
_PERSON = ("name", "email", "section")


class OverrideLine(msgspec.Struct, frozen=True):
    """A score an instructor set."""

    score: float
    reason: str
    at: str


class GradeLine(msgspec.Struct, frozen=True, kw_only=True, tag="course.grade/1", tag_field="schema"):
    """One student and exercise: the body of ``course.check/1`` and the fields that a grading run adds.

    ``score`` counts, ``raw_score`` is the checks' sum; both are null after a fault of the grader's.
    """

    ok: bool
    exit_code: int
    course: CourseRef
    student: str
    exercise: str
    scope: str
    state: str
    score: float | None
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
    raw_score: float | None = None
    late_penalty: float = 0.0
    override: OverrideLine | None = None
    submitted_at: str | None = None


def grade_line(effective: Effective, course: CourseRef) -> GradeLine:
    """A result as its line of JSON."""
    verdict, key, override = effective.verdict, effective.result.key, effective.override
    codes = {"ungradable": 3, "grader_error": 70, NOT_YET: 3}
    return GradeLine(
        ok=verdict.all_pass,
        exit_code=codes.get(verdict.state, 0 if verdict.all_pass else 1),
        course=course,
        student=key.student,
        exercise=key.exercise,
        scope=verdict.scope,
        state=verdict.state,
        score=effective.score,
        max_score=effective.max_score,
        passed=effective.passed,
        checks=verdict.checks,
        error=verdict.error,
        submission_sha256=key.submission_sha256,
        grader_version=key.grader_version,
        seed=key.seed,
        isolation=verdict.isolation,
        late=effective.late,
        graded_at=effective.result.graded_at,
        warnings=verdict.warnings,
        raw_score=effective.raw_score,
        late_penalty=effective.penalty,
        override=OverrideLine(override.score, override.reason, override.at)
        if override is not None and override.score is not None
        else None,
        submitted_at=utc(effective.submitted_at) or None,
    )


def utc(seconds: float | None) -> str:
    """A time as ISO 8601; empty for None."""
    return "" if seconds is None else time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime(seconds))


def write_jsonl(path: Path, results: Iterable[Effective], course: CourseRef) -> None:
    """One line per student and exercise, with everything: for the instructor only.

    Raises:
        MissingCapabilityError: it cannot be written.
    """
    with replacing(path) as handle:
        for effective in results:
            line = grade_line(effective, course)
            handle.write(msgspec.json.encode(finite(msgspec.to_builtins(line))) + b"\n")


def write_csv(path: Path, results: Results, chosen: Iterable[Effective] | None = None) -> None:
    """One row per student and exercise; every cell quoted, none of them a formula.

    Args:
        chosen: the rows; all if None.

    Raises:
        MissingCapabilityError: it cannot be written.
    """
    wanted = results.all() if chosen is None else chosen
    headings = (*_COLUMNS, *_PERSON) if results.roster else _COLUMNS
    write_bytes(path, csv_bytes(headings, (_row(results, effective) for effective in wanted)))


def _row(results: Results, effective: Effective) -> list[str]:
    verdict, override = effective.verdict, effective.override
    cells = [
        effective.student,
        effective.exercise,
        number(effective.score),
        number(effective.max_score),
        "yes" if effective.passed else "no",
        verdict.state,
        verdict.error.code if verdict.error else "",
        "" if effective.late is None else f"{effective.late:.0f}",
        verdict.isolation,
        number(effective.raw_score),
        number(effective.penalty),
        override.reason if override else "",
        utc(effective.submitted_at),
        effective.result.graded_at,
    ]
    if results.roster:
        person = results.person(effective.student)
        cells += [person.name, person.email, person.section] if person else ["", "", ""]
    return cells
