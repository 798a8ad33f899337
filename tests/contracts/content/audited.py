"""The audit of the course in parts: each exercise alone, and the rest, so that no worker has it all."""

from __future__ import annotations

from functools import partial

from course.authoring.audit import audit
from course.authoring.exercises.grading import grade_sources
from course.authoring.exercises.variants import accepted_files
from course.catalog.load import Catalog

__all__ = ["CATALOG", "EXERCISES", "IN_PART", "LONGEST", "programs", "wrong"]

CATALOG = Catalog()
EXERCISES = CATALOG.exercise_ids()
#: Its audit takes as long as those of all other exercises together.
LONGEST = "sim-to-real"
#: As `course author check` does it; all processors are at work on other tests already.
IN_PART = partial(audit, CATALOG, grade=partial(grade_sources, graders=1))


def wrong(exercise: str) -> list[str]:
    """What the audit finds wrong with an exercise, all of whose programs it must have graded."""
    report = IN_PART(exercise)
    assert report.exercises == (exercise,)
    assert report.graded == programs(exercise)
    return [f"{p.where}: {p.message} {p.fix}" for p in report.problems]


def programs(exercise: str) -> int:
    """How many programs prove an exercise: its stub, its solution, and the solution's variants."""
    it = CATALOG.exercise(exercise)
    return 2 + len(accepted_files(CATALOG, it)) + len(CATALOG.mutants(it))
