"""The one seam between authoring and grading: what checks there are, and verdicts on sources."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from course.catalog.load import Catalog
    from course.catalog.models import Exercise
    from course.scoring.collected import Check
    from course.scoring.verdict import Verdict

__all__ = ["GradeSources", "declared_checks", "grade_sources"]

#: Gradings of small exercises that take as long as starting one more process for them.
_WORTH_A_GRADER = 15

GradeSources: TypeAlias = "Callable[[Sequence[tuple[Exercise, bytes]]], Iterator[tuple[int, Verdict]]]"


def grade_sources(sources: Sequence[tuple[Exercise, bytes]]) -> Iterator[tuple[int, Verdict]]:
    """Grade sources with all checks of their exercises, as a grading run would, on every processor.

    The seed is fixed: the same files get the same verdicts, whichever of them are done first.

    Args:
        sources: exercise and submission of each.

    Yields:
        Index and verdict, in the order in which they are reached.

    Raises:
        CourseError: nothing can be graded here.
    """
    from course.engines.machine import this_machine
    from course.grading.intake.students import Entry
    from course.grading.running.batch import grade_all
    from course.scoring.session import Submission
    from course.scoring.terms import Terms

    entries = (
        Entry(str(index), exercise, Submission(files={exercise.module: source}))
        for index, (exercise, source) in enumerate(sources)
    )
    graders = min(this_machine().cores, 1 + len(sources) // _WORTH_A_GRADER)
    for graded in grade_all(entries, Terms(), graders=graders):
        yield int(graded.entry.student), graded.verdict


def declared_checks(exercise: Exercise, catalog: Catalog) -> dict[str, Check]:
    """The checks as pytest collects them, by id: markers whose values are computed have them here.

    Raises:
        ContentError: a file cannot be imported, or a check lacks its marks.
    """
    from course.scoring.collected import CollectedChecks
    from course.scoring.session import check_files

    collected = CollectedChecks(check_files(exercise, catalog, "full"))
    try:
        return {check.id: check for check in collected.checks}
    finally:
        collected.close()
