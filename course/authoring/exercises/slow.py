"""How long the slow public checks of an exercise take, measured and written into ``exercise.toml``.

It determines how long ``course check`` waits for a function that may hang; see ``Exercise.patience``.
"""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING

from course.authoring.exercises.variants import accepted_files, compose, solution_path
from course.catalog.models import QUICK
from course.catalog.reading import read_text
from course.progress.workspace import write_atomically
from course.scoring.judging.session import GradingSession, Submission
from course.scoring.judging.terms import Terms

if TYPE_CHECKING:
    from pathlib import Path

    from course.authoring.exercises.source import CheckSource
    from course.authoring.report import Findings
    from course.catalog.load import Catalog
    from course.catalog.models import Exercise

__all__ = ["audit_slow", "due", "measured", "write_slow"]

#: A number is replaced once a check takes longer, or less than this share of it: times vary by two.
_LEAST = 0.4


def audit_slow(exercise: Exercise, checks: tuple[CheckSource, ...], findings: Findings) -> None:
    """Report slow checks that do not exist."""
    known = {check.id for check in checks if not check.hidden}
    for check in sorted(exercise.slow.keys() - known):
        path = exercise.checks_path.with_name("exercise.toml")
        message, fix = f"there is no public check {check}.", f"Run `course author build {exercise.id}`."
        findings.add(path, None, "slow", message, fix)


def measured(catalog: Catalog, exercise: Exercise) -> dict[str, float]:
    """The most CPU time that each public check takes of a right solution, in s."""
    solution, most = solution_path(catalog, exercise), dict[str, float]()
    sources = [solution.read_bytes(), *(compose(solution, one) for one in accepted_files(catalog, exercise))]
    with GradingSession(exercise, catalog, terms=Terms(timeout=60.0)) as session:
        for source in sources:
            session.grade(Submission({exercise.module: source}))
            for check, seconds in session.took.items():
                most[check] = max(seconds, most.get(check, 0.0))
    return most


def due(written: dict[str, float], most: dict[str, float]) -> dict[str, float]:
    """The value to write, from the present and the measured one: in tenths, rounded up."""
    kept = {check: old for check, old in written.items() if _LEAST * old <= most.get(check, 0.0) <= old}
    slow = {check: math.ceil(10 * seconds) / 10 for check, seconds in most.items() if seconds > QUICK}
    return dict(sorted({**slow, **kept}.items()))


def write_slow(catalog: Catalog, exercise: Exercise) -> Path | None:
    """Measure, and write the new value; None if it is there already."""
    slow = due(exercise.slow, measured(catalog, exercise))
    if slow == exercise.slow:
        return None
    path = exercise.checks_path.with_name("exercise.toml")
    text = re.sub(r"^slow = .*\n", "", read_text(path), flags=re.MULTILINE)
    if slow:
        line = ", ".join(f"{check} = {seconds:g}" for check, seconds in slow.items())
        above, task, below = text.partition("\n[[task]]")
        text = f"{above.rstrip()}\nslow = {{ {line} }}\n{task}{below}"
    write_atomically(path, text.encode())
    return path
