"""Sums over the checks of an exercise: written into ``exercise.toml``, and refused there when stale.

A student's wheel has no hidden checks, so their number and points are data there. They are computed from the
markers of the checks, which say what each is worth.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

from course.authoring.exercises.checks import declared
from course.catalog.models import Exercise
from course.catalog.reading import read_document, read_text
from course.progress.workspace import write_atomically

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from course.authoring.exercises.source import CheckSource
    from course.authoring.report import Findings
    from course.catalog.load import Catalog

__all__ = ["audit_points", "write_points"]

#: Decimals that are written: sums of markers such as 0.1 are exact to far more.
_DIGITS = 9


@dataclass(frozen=True, slots=True)
class _Sum:
    """A number of ``exercise.toml`` that follows from the checks.

    Attributes:
        where: its key, as steps from the top of the file.
        about: its meaning, in words.
        written, due: the value in the file, and the sum over the checks.
    """

    where: tuple[str | int, ...]
    about: str
    written: float
    due: float

    @property
    def stale(self) -> bool:
        """Whether another number is due."""
        return round(self.written - self.due, _DIGITS) != 0


def _sums(exercise: Exercise, checks: tuple[CheckSource, ...]) -> Iterator[_Sum]:
    hidden = [check for check in checks if check.hidden]
    yield _Sum(("hidden_checks",), "the hidden checks", exercise.hidden_checks, len(hidden))
    points = sum(check.points or 0.0 for check in hidden)
    yield _Sum(("hidden_points",), "the points of the hidden checks", exercise.hidden_points, points)
    for index, task in enumerate(exercise.task):
        points = sum(check.points or 0.0 for check in checks if check.task == task.id)
        about = f"the points of task {task.id}, public and hidden,"
        yield _Sum(("task", index, "points"), about, task.points, points)


def audit_points(exercise: Exercise, checks: tuple[CheckSource, ...], findings: Findings) -> None:
    """Report each number that differs from the sum over the checks."""
    path = exercise.checks_path.with_name("exercise.toml")
    lines = read_document(path, Exercise).lines
    for one in _sums(exercise, checks):
        if one.where[0] == "task" and not one.due:
            task = exercise.task[int(one.where[1])].id
            message, fix = (
                f"no check gives task {task} a point.",
                "Mark a check of it: @pytest.mark.points(2).",
            )
            findings.add(path, lines.line(one.where), "points", message, fix)
        elif one.stale:
            message = f"{one.about} come to {one.due:g}, and {one.written:g} is written here."
            fix = f"Run `course author build {exercise.id}`."
            findings.add(path, lines.line(one.where), "points", message, fix)


def write_points(catalog: Catalog, exercise: Exercise) -> Path | None:
    """Write the sums over the checks; None if they are there already.

    Raises:
        ContentError: a file is missing, is not Python, or a check lacks its markers.
    """
    path = exercise.checks_path.with_name("exercise.toml")
    lines = read_document(path, Exercise).lines
    text = read_text(path).split("\n")
    stale = [
        one
        for one in _sums(exercise, declared(catalog, exercise))
        if one.stale and (one.due or one.where[0] != "task")
    ]
    # From the bottom up, so that a line that is put in moves none that is still to be changed.
    for one in sorted(stale, key=lambda one: lines.line(one.where), reverse=True):
        key, at = str(one.where[-1]), lines.line(one.where) - 1
        line = f"{key} = {round(one.due, _DIGITS):.{_DIGITS}g}"
        if re.match(rf"\s*{key}\s*=", text[at]):
            text[at] = re.sub(r"[^#]*?(?=\s*(#|$))", line, text[at], count=1)
        else:
            # It was left out: the last line above the first task.
            last = next(i for i in range(lines.line(("task",)) - 2, 0, -1) if text[i].strip())
            text.insert(last + 1, line)
    if not stale:
        return None
    write_atomically(path, "\n".join(text).encode())
    return path
