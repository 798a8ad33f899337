"""The audit of the course in parts: each exercise alone, and the rest, so that no worker has it all."""

import functools
import itertools
from collections.abc import Iterator, Sequence

from course.authoring.audit import audit
from course.authoring.exercises.grading import accepted_files, grade_sources, mistakes_of
from course.authoring.report import AuditReport
from course.catalog.load import Catalog
from course.catalog.models import Exercise
from course.scoring.verdict import Verdict
from tests.benchmarks.calibration.seeds import proven

CATALOG = Catalog()
EXERCISES = CATALOG.exercise_ids()
#: As `course author check` does it; all processors are at work on other tests already.
IN_PART = functools.partial(audit, CATALOG, grade=functools.partial(grade_sources, graders=1))
#: One in so many of the programs on record is graded once more: that grading works is seen from fewer.
EACH = 24


@functools.cache
def on_record(exercise: str) -> frozenset[bytes]:
    """The variants of an exercise whose proof is on record and holds."""
    return proven(CATALOG.exercise(exercise), CATALOG)


def changed(exercise: str) -> AuditReport:
    """The audit of an exercise, where only some programs are graded whose proof is on record and holds.

    The record (tests/benchmarks/calibration/seeds.jsonl) says of each variant that it was graded as declared,
    under hundreds of seeds where its checks draw, and by which checks: once a check or the program changes,
    it is graded here. A change in how the course grades is seen from those that are graded again, and in CI.
    """

    def grade(sources: Sequence[tuple[Exercise, bytes]]) -> Iterator[tuple[int, Verdict]]:
        kept = on_record(exercise)
        again = itertools.cycle([True] + (EACH - 1) * [False])
        left = [n for n, (_, source) in enumerate(sources) if source not in kept or next(again)]
        for index, verdict in grade_sources([sources[n] for n in left], graders=1):
            yield left[index], verdict

    return audit(CATALOG, exercise, grade=grade)


def wrong(report: AuditReport) -> list[str]:
    """What the audit found, a line each."""
    return [f"{p.where}: {p.message} {p.help}" for p in report.problems]


def programs(exercise: str) -> int:
    """How many programs prove an exercise: its stub, its solution, and the solution's variants."""
    it = CATALOG.exercise(exercise)
    mistakes = mistakes_of(CATALOG, it)
    return 2 + len(accepted_files(CATALOG, it)) + len(mistakes.right) + len(mistakes.wrong)
