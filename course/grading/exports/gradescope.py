"""Gradescope's ``results.json``: an autograder's answer there, one file per submission.

Everything in it may be shown to the student, so it contains only what students may read. A hidden check is
shown only after the due date, because students may hand in as often as they like, and could otherwise try
until it passes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import msgspec

from course.grading.exports.cells import csv_bytes, number, write_bytes
from course.grading.exports.handout import checks_for_student, problem_for_student
from course.grading.exports.selection import ExportOptions, Written, check_settled, select
from course.printable import one_line
from course.scoring.numbers import in_points
from course.scoring.verdict import CheckResult, Problem, Status, Visibility, finite

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from course.grading.results.effective import Effective, Results

__all__ = ["results_body", "write_gradescope"]

_WHAT_FOR = (
    "Each JSON file is what an autograder leaves at /autograder/results/results.json for one submission; an "
    "autograder of your own can hand them out. index.csv says whose is which. To grade in Gradescope itself, "
    "use --format gradescope-autograder."
)
_LONGEST = 4000  # characters of one check's words: a student's function may return anything


def write_gradescope(folder: Path, results: Results, options: ExportOptions) -> Written:
    """A folder with one results file per student and exercise, and ``index.csv``, which names the owners.

    Raises:
        UsageError: no such exercise.
        MissingCapabilityError: students are missing in the roster, or a file cannot be written.
    """
    selection = select(results, options)
    check_settled(selection, options)
    rows: list[Sequence[str]] = []
    for effective in (item for item in selection.each() if not item.missing):
        # A student's id never becomes a path.
        name = f"{len(rows) + 1:05}.json"
        body = results_body([effective])
        write_bytes(folder / name, msgspec.json.format(msgspec.json.encode(body), indent=1))
        person = selection.people.get(effective.student)
        about = [person.name, person.email] if person else ["", ""]
        rows.append([name, effective.student, *about, effective.exercise, number(effective.score)])
    index = folder / "index.csv"
    write_bytes(index, csv_bytes(["file", "student", "name", "email", "exercise", "score"], rows))
    selection.written.paths += [index, folder]
    selection.written.notes.append(_WHAT_FOR)
    return selection.written


def results_body(found: Sequence[Effective]) -> dict[str, Any]:
    """The body of one ``results.json`` over all exercises of one submission."""
    tests = [
        _test(effective.exercise, number_, check)
        for effective in found
        for number_, check in enumerate(checks_for_student(effective.verdict), 1)
    ]
    tests += [
        _not_graded(effective, problem)
        for effective in found
        if (problem := problem_for_student(effective.verdict)) is not None
    ]
    scores = [effective.score for effective in found if effective.score is not None]
    body: dict[str, Any] = {
        "score": round(sum(scores), 4),
        "execution_time": round(sum(_seconds(effective) for effective in found), 3),
        "output": "\n\n".join(_words(effective) for effective in found),
        "output_format": "text",
        "visibility": "visible",
        "stdout_visibility": "hidden",
        "tests": tests,
        "extra_data": {"results": [_extra(effective) for effective in found]},
    }
    return dict(finite(body))


def _seconds(effective: Effective) -> float:
    """The time of the public checks alone: a function's time could reveal its hidden inputs."""
    return sum(check.duration_ms for check in checks_for_student(effective.verdict)) / 1e3


def _words(effective: Effective) -> str:
    """The text about the submission as a whole."""
    verdict = effective.verdict
    score = "no score yet" if effective.score is None else f"{number(effective.score)} points"
    said = [f"{effective.exercise}: {score} of {number(effective.max_score)}."]
    problem = problem_for_student(verdict)
    if problem is not None:
        said += [problem.message, problem.help]
    if effective.penalty:
        said.append(f"Lateness cost {in_points(effective.penalty)}.")
    if effective.override is not None:
        said.append(f"Score set by the instructor: {effective.override.reason}")
    return _plain("\n".join(part for part in (*said, *verdict.warnings) if part))


def _test(exercise: str, number_: int, check: CheckResult) -> dict[str, Any]:
    said = [check.message, check.help, f"Diagnosis: {check.diagnosis}" if check.diagnosis else ""]
    if check.blocked_by:
        said.append(f"Runs once {check.blocked_by} passes.")
    public = check.visibility is Visibility.PUBLIC
    if public and check.expected is not None:
        units = f" {check.units}" if check.units not in {"", "1"} else ""
        said.append(f"Measured {check.actual}{units}, expected {check.expected}{units}.")
    return {
        "name": _plain(check.title),
        "number": f"{exercise}.{number_}",
        "score": check.points,
        "max_score": check.max_points,
        "status": "passed" if check.status is Status.PASS else "failed",
        "output": _plain("\n".join(part for part in said if part))[:_LONGEST],
        "output_format": "text",
        "tags": [exercise, check.task, check.status.value],
        "visibility": "visible" if public else "after_due_date",
        "extra_data": {"id": check.id, "diagnosis": check.diagnosis},
    }


def _not_graded(effective: Effective, error: Problem) -> dict[str, Any]:
    return {
        "name": f"{effective.exercise} could not be graded",
        "score": 0.0,
        "max_score": 0.0,
        "status": "failed",
        "output": _plain(f"{error.message}\n{error.help}"),
        "output_format": "text",
        "tags": [effective.exercise, effective.verdict.state],
        "visibility": "visible",
        "extra_data": {"code": error.code},
    }


def _extra(effective: Effective) -> dict[str, Any]:
    return {
        "exercise": effective.exercise,
        "state": effective.verdict.state,
        "score": effective.score,
        "max_score": effective.max_score,
        "passed": effective.passed,
        "late": effective.late,
        "isolation": effective.verdict.isolation,
        "grader_version": effective.result.key.grader_version,
        "submission_sha256": effective.result.key.submission_sha256,
    }


def _plain(text: str) -> str:
    return "\n".join(one_line(line) for line in text.split("\n"))
