"""The one seam between authoring and grading: what checks there are, and verdicts on sources."""

from __future__ import annotations

import contextlib
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from contextlib import AbstractContextManager

    from course.catalog.load import Catalog
    from course.catalog.models import Exercise
    from course.grading.collected import Check
    from course.grading.verdict import Verdict

__all__ = ["Grade", "OpenGrader", "declared_checks", "grading_session"]

Grade: TypeAlias = "Callable[[bytes], Verdict]"
OpenGrader: TypeAlias = "Callable[[Exercise, Catalog], AbstractContextManager[Grade]]"


@contextlib.contextmanager
def grading_session(exercise: Exercise, catalog: Catalog) -> Iterator[Grade]:
    """Grade sources with all checks of an exercise, as a grading run would.

    The seed is fixed: an audit of the same files gives the same answer.
    """
    from course.grading.session import GradingSession, Submission

    with GradingSession(exercise, catalog, scope="full", seed=0) as session:

        def grade(source: bytes) -> Verdict:
            return session.grade(Submission(files={exercise.module: source}))

        yield grade


def declared_checks(exercise: Exercise, catalog: Catalog) -> dict[str, Check]:
    """The checks as pytest collects them, by id: markers whose values are computed have them here.

    Raises:
        ContentError: a file cannot be imported, or a check lacks its marks.
    """
    from course.grading.collected import CollectedChecks
    from course.grading.session import check_files

    collected = CollectedChecks(check_files(exercise, catalog, "full"))
    try:
        return {check.id: check for check in collected.checks}
    finally:
        collected.close()
