"""The report of an exercise: its ``report.py``, run on a submission through the boundary of the checks."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from course.errors import NotFoundError, UngradableError
from course.isolation.failures import StudentFailure
from course.scoring.checks.companions import companion
from course.scoring.failures import CheckFailed
from course.scoring.judging.session import GradingSession, Submission
from course.scoring.judging.terms import Terms
from course.scoring.report import Report, finding_for

if TYPE_CHECKING:
    from course.catalog.load import Catalog
    from course.catalog.models import Exercise

__all__ = ["has_report", "report_of"]

FILE = "report.py"


def has_report(exercise: Exercise) -> bool:
    """Whether the exercise has something to show."""
    return (Path(exercise.folder) / FILE).is_file()


def report_of(
    exercise: Exercise, catalog: Catalog, submission: Submission, *, timeout: float = 60.0
) -> Report:
    """The report on a submission.

    Args:
        timeout: wall seconds for all of it.

    Raises:
        NotFoundError: the exercise has no report.
        UngradableError: the submission cannot be loaded, or ended the report.
        MissingCapabilityError: no submission can be run on this machine.
    """
    if not has_report(exercise):
        raise NotFoundError(
            f"The exercise {exercise.id} has no report.",
            help=f"See what its checks say: course check {exercise.id}",
            code="report_not_found",
        )
    module = companion(exercise.id, FILE.removesuffix(".py"))
    try:
        with GradingSession(exercise, catalog, terms=Terms(timeout=timeout)) as session:
            report: Report = session.using(submission, module.report)
    except (StudentFailure, CheckFailed) as failure:
        finding = finding_for(failure)
        raise UngradableError(finding.message, help=finding.help or "", code="report_stopped") from None
    return report
