"""Results of checks and problems of submissions, put into the words and fields of a verdict."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from course.scoring.values import plain
from course.scoring.verdict import CheckResult, Finding, Problem, Status

if TYPE_CHECKING:
    from course.catalog.models import Exercise
    from course.isolation.session import LoadRefusedError
    from course.scoring.collected import Check
    from course.scoring.places import Places

__all__ = ["found", "load_problem", "no_functions", "result", "skipped"]


def result(check: Check, status: Status, **fields: Any) -> CheckResult:
    return CheckResult(
        id=check.id,
        title=check.title,
        task=check.task,
        status=status,
        visibility=check.visibility,
        points=fields.pop("points", 0.0),
        max_points=check.points,
        **fields,
    )


def found(check: Check, status: Status, finding: Finding, duration_ms: float, **extra: Any) -> CheckResult:
    return result(
        check,
        status,
        duration_ms=duration_ms,
        message=finding.message,
        help=finding.help,
        diagnosis=finding.diagnosis,
        input=plain(finding.input, 4),  # a dict of arrays, such as one of matrices
        expected=plain(finding.expected),
        actual=plain(finding.actual),
        units=finding.units,
        tolerance=finding.tolerance,
        first_divergence=finding.first_divergence,
        **extra,
    )


def skipped(check: Check, blocking: str) -> CheckResult:
    return result(
        check,
        Status.SKIP,
        blocked_by=blocking,
        message="Not run: it builds on a check that did not pass.",
        help="Repair that one first.",
    )


def load_problem(refused: LoadRefusedError, places: Places) -> Problem:
    failure = refused.failure
    module = places.module
    where = places.heading(failure.line) if failure.line else module
    if refused.stage == "syntax":
        return Problem("syntax_error", *_unreadable(refused, where))
    if refused.stage == "timeout":
        message = f"{module} did not finish loading in time."
        return Problem(
            "import_timeout", message, "Move work out of the top level of the file, into functions."
        )
    if refused.stage == "import" and failure.type == "ImportNotDeclaredError":
        return Problem(
            "import_error",
            f"{where}: {failure.message}.",
            "Take that import out. Plots and experiments belong in a file of your own that imports this one.",
        )
    if refused.stage == "import":
        return Problem(
            "import_error",
            f"{where}: loading it raises {failure.type}: {failure.message}.",
            "A file that is checked must load without errors: try `python -c 'import ...'` on it.",
        )
    message = f"{module} ends its process while it is loaded ({failure.message})."
    return Problem(
        "import_crash", message, "Remove what exits, kills or exhausts the process at the top level."
    )


def _unreadable(refused: LoadRefusedError, where: str) -> tuple[str, str]:
    """What is wrong with a file that is no Python, and what to do about it."""
    failure = refused.failure
    if "UnicodeError" in failure.bases:
        message = f"{where}: Python cannot read this file: {failure.message}."
        return message, "Save it as UTF-8, or declare its encoding in the first line."
    if not failure.line:
        message = f"{where} is no Python source: {failure.message}."
        return (
            message,
            "Was something else saved under its name? `course reset` puts the stub back, and keeps it.",
        )
    shown = f": `{refused.text.strip()}`" if refused.text.strip() else ""
    message = f"{where}: Python cannot read this file: {failure.message}{shown}."
    return message, "Run `python -m py_compile` on it, or look at that line and the one above it."


def no_functions(exercise: Exercise) -> Problem:
    names = ", ".join(task.id for task in exercise.task)
    return Problem(
        "no_declared_functions",
        f"{exercise.module} defines none of the functions of this exercise.",
        f"Keep the names the stub gave: {names}.",
    )
