"""The audit of an exercise's checks as declared: titles, markers, points, and the words they show."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

from course.authoring.exercises.grading import declared_checks
from course.authoring.exercises.source import DECIMAL, CheckSource, checks_in, parse, quoted_numbers
from course.authoring.exercises.variants import exercise_graders
from course.catalog.reading import read_text

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from course.authoring.report import Findings
    from course.catalog.load import Catalog
    from course.catalog.models import Exercise

__all__ = ["audit_checks", "declared", "public_numbers"]


def audit_checks(catalog: Catalog, exercise: Exercise, findings: Findings) -> tuple[CheckSource, ...]:
    """Audit the checks of an exercise, public ones first, and return them.

    Raises:
        ContentError: a file is missing or is not Python.
    """
    checks = declared(catalog, exercise)
    first: dict[str, CheckSource] = {}
    for check in checks:
        if check.id in first:
            other = first[check.id].path.parent.name
            _wrong(findings, check, "exists twice.", f"Rename it; the other is in {other}.")
        first.setdefault(check.id, check)
    for check in checks:
        _audit_check(exercise, check, first, findings)
    _audit_words(exercise, exercise_graders(catalog, exercise), findings)
    return checks


def declared(catalog: Catalog, exercise: Exercise) -> tuple[CheckSource, ...]:
    """The checks of an exercise with their markers, public ones first.

    Raises:
        ContentError: a file is missing or is not Python.
    """
    public, hidden = exercise.checks_path, exercise_graders(catalog, exercise) / "checks.py"
    checks = tuple(checks_in(public, parse(public), hidden=False))
    if hidden.is_file() or not exercise.is_warm_up:
        checks += tuple(checks_in(hidden, parse(hidden), hidden=True))
    return _with_computed_marks(catalog, exercise, checks)


def _with_computed_marks(
    catalog: Catalog, exercise: Exercise, checks: tuple[CheckSource, ...]
) -> tuple[CheckSource, ...]:
    """Ask pytest for the values of markers that are not plain values in the source.

    Not while a check lacks a marker or its docstring: then nothing can be collected, and that is reported.
    """
    complete = all(
        check.title
        and (check.task is not None or "task" in check.indirect)
        and (check.points is not None or "points" in check.indirect)
        for check in checks
    )
    if not complete or not any(check.indirect for check in checks):
        return checks
    known = declared_checks(exercise, catalog)
    return tuple(
        replace(
            check, task=known[check.id].task, points=known[check.id].points, requires=known[check.id].requires
        )
        if check.id in known
        else check
        for check in checks
    )


def _audit_check(
    exercise: Exercise, check: CheckSource, known: dict[str, CheckSource], findings: Findings
) -> None:
    """One check: its docstring, its markers, and what it depends on."""
    if not check.title:
        fix = "Start the function with a docstring of one line: what is true of right code."
        _wrong(findings, check, "has no title.", fix)
    if check.task is None:
        if "task" not in check.indirect:
            _wrong(findings, check, "has no task.", 'Mark it: @pytest.mark.task("name of the function").')
    elif check.task not in {task.id for task in exercise.task}:
        _wrong(
            findings, check, f"belongs to a task {check.task!r} that does not exist.", "Correct the marker."
        )
    if check.points is None:
        if "points" not in check.indirect:
            _wrong(findings, check, "has no points.", "Mark it: @pytest.mark.points(2).")
    elif not (check.points >= 0 and math.isfinite(check.points)):
        _wrong(findings, check, "has no points that could be added up.", "Give it a number, 0 or more.")
    for required in check.requires:
        if required not in known:
            _wrong(findings, check, f"requires {required!r}, which is not a check.", "Correct the marker.")
        elif known[required].hidden and not check.hidden:
            fix = "Let it depend on public checks alone: a student has no others."
            _wrong(findings, check, f"is public and requires the hidden check {required}.", fix)
    if check.id in _needed_for(check.requires, known):
        _wrong(findings, check, "requires itself, by way of others.", "Remove one of the markers.")


def _needed_for(ids: Iterable[str], known: dict[str, CheckSource]) -> set[str]:
    """Every check that must pass first, directly or indirectly."""
    needed: set[str] = set()
    left = list(ids)
    while left:
        name = left.pop()
        if name in known and name not in needed:
            needed.add(name)
            left += known[name].requires
    return needed


def _audit_words(exercise: Exercise, graders: Path, findings: Findings) -> None:
    """The words of hidden checks contain no decimal number, unless the student already has it in a file."""
    public = public_numbers(exercise)
    for path in sorted(graders.glob("*.py")):
        for line, number in quoted_numbers(parse(path)):
            if number not in public:
                findings.add(
                    path,
                    line,
                    "leak",
                    f"a text that a hidden check shows contains the number {number}.",
                    "Say it in words; put values into input, expected and actual, which are not shown.",
                )


def public_numbers(exercise: Exercise) -> frozenset[str]:
    """Decimal numbers in the student's files: showing them reveals nothing."""
    files = [path for path in exercise.stub_path.parent.rglob("*") if path.suffix in {".py", ".md", ".toml"}]
    return frozenset(match[0] for path in files for match in DECIMAL.finditer(read_text(path)))


def _wrong(findings: Findings, check: CheckSource, message: str, fix: str) -> None:
    findings.add(check.path, check.line, "check", f"check {check.id} {message}", fix)
