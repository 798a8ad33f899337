"""The audit of the course in parts: each exercise alone, and the rest, so that no worker has it all."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from course.authoring.audit import audit
from course.authoring.exercises.grading import declared_checks, grade_sources
from course.authoring.exercises.mutants import mutant_path
from course.authoring.exercises.variants import accepted_files, compose, solution_path
from course.catalog.load import Catalog

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from course.authoring.exercises.grading import GradeSources
    from course.catalog.models import Exercise
    from course.scoring.checks.collected import Check
    from course.scoring.verdict import Verdict

__all__ = ["CATALOG", "EXERCISES", "IN_FULL", "LONGEST", "programs", "wrong"]

CATALOG = Catalog()
EXERCISES = CATALOG.exercise_ids()
#: Its audit takes as long as those of all other exercises together.
LONGEST = "sim-to-real"
#: As `course author check` does it; all processors are at work on other tests already.
IN_FULL = partial(grade_sources, graders=1)


def as_declared(sources: Sequence[tuple[Exercise, bytes]]) -> Iterator[tuple[int, Verdict]]:
    """Grade a mutant by its task's checks up to the one that it names, and by those of other tasks.

    That proves its line of docs/graders.md in two thirds of the time: a check that fails asks many questions.
    One that is named by a check without points must lose them at another, and is graded by all.
    """
    named: dict[tuple[str, bytes], tuple[str, str]] = {}
    checks: dict[str, list[Check]] = {}
    for exercise in dict.fromkeys(exercise for exercise, _ in sources):
        checks[exercise.id] = list(declared_checks(exercise, CATALOG).values())
        for mutant in CATALOG.mutants(exercise):
            source = compose(solution_path(CATALOG, exercise), mutant_path(CATALOG, exercise, mutant))
            named[exercise.id, source] = mutant.task, mutant.check

    def spare(exercise: Exercise, source: bytes) -> list[str]:
        task, name = named.get((exercise.id, source), ("", ""))
        own = [check for check in checks[exercise.id] if check.task == task]
        ends = next((n for n, check in enumerate(own, 1) if check.id == name and check.points), len(own))
        return [check.id for check in own[ends:]]

    return grade_sources(sources, graders=1, spare=spare)


def wrong(exercise: str, *, grade: GradeSources = as_declared) -> list[str]:
    """What the audit finds wrong with an exercise, all of whose programs it must have graded."""
    report = audit(CATALOG, exercise, grade=grade)
    assert report.exercises == (exercise,)
    assert report.graded == programs(exercise)
    return [f"{p.where}: {p.message} {p.fix}" for p in report.problems]


def programs(exercise: str) -> int:
    """How many programs prove an exercise: its stub, its solution, and the solution's variants."""
    it = CATALOG.exercise(exercise)
    return 2 + len(accepted_files(CATALOG, it)) + len(CATALOG.mutants(it))
