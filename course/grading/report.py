"""What an exercise shows a student about their own code: text, tables and figures on public data.

An exercise that has something to show ships ``report.py`` with a function ``report(submission)``. It calls
the student's functions through the same boundary as the checks do.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from course.errors import NotFoundError, UngradableError
from course.grading.failures import CheckFailed, finding_of
from course.grading.verdict import Finding
from course.isolation.failures import StudentFailure

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from course.catalog.load import Catalog
    from course.catalog.models import Exercise
    from course.figures.described import Plot

__all__ = ["Report", "Section", "guarded_section", "has_report", "report_of"]

FILE = "report.py"


@dataclass(frozen=True)
class Section:
    """One part of a report.

    Attributes:
        text: paragraphs, separated by empty lines; lines that begin with "- " are items.
        columns, rows: a table; every cell is text with its unit.
        plot: a figure.
    """

    title: str
    text: str = ""
    columns: tuple[str, ...] = ()
    rows: tuple[tuple[str, ...], ...] = ()
    plot: Plot | None = None


@dataclass(frozen=True)
class Report:
    """Everything a report shows.

    Attributes:
        streams: recorded sensor streams by kind, for whoever wants them as a ROS 2 bag.
    """

    title: str
    sections: tuple[Section, ...]
    streams: Mapping[str, Any] = field(default_factory=dict)


def guarded_section(title: str, make: Callable[[], Section]) -> Section:
    """The section that ``make()`` gives; where the student's code fails it, what went wrong instead."""
    try:
        return make()
    except (StudentFailure, CheckFailed) as failure:
        finding = _finding(failure)
        return Section(title, "\n\n".join(part for part in (finding.message, finding.help) if part))


def has_report(exercise: Exercise) -> bool:
    """Whether the exercise has something to show."""
    return (Path(exercise.folder) / FILE).is_file()


def report_of(
    exercise: Exercise, catalog: Catalog, files: Mapping[str, bytes], *, timeout: float = 60.0
) -> Report:
    """The report on a submission.

    Args:
        files: the submission: file name to content.
        timeout: wall seconds for all of it.

    Raises:
        NotFoundError: the exercise has no report.
        UngradableError: the submission cannot be loaded, or broke the report off.
        MissingCapabilityError: no submission can be run on this machine.
    """
    from course.grading import kit
    from course.grading.session import GradingSession, Submission

    if not has_report(exercise):
        raise NotFoundError(
            f"The exercise {exercise.id} has no report.",
            help=f"See what its checks say: course check {exercise.id}",
            code="report_not_found",
        )
    module = kit.companion(exercise.id, FILE.removesuffix(".py"))
    try:
        with GradingSession(exercise, catalog, timeout=timeout) as session:
            report: Report = session.using(Submission(files), module.report)
    except (StudentFailure, CheckFailed) as failure:
        finding = _finding(failure)
        raise UngradableError(finding.message, help=finding.help or "", code="report_stopped") from None
    return report


def _finding(failure: StudentFailure | CheckFailed) -> Finding:
    """The failure in words; a function that is still to be written is named.

    A check does not name it, because hidden inputs could leave in a name. A report has none.
    """
    if isinstance(failure, CheckFailed):
        return failure.finding
    finding = finding_of(failure)
    functions = _FRAME.findall(failure.traceback)
    if failure.is_a("NotImplementedError") and functions:
        message = f"`{functions[-1]}` is not written yet: it still raises NotImplementedError."
        return Finding(message=message, help=finding.help, diagnosis=finding.diagnosis)
    return finding


#: The function of a line of a traceback, as ``StudentFailure`` has it: "file.py:12 in name".
_FRAME = re.compile(r"^\S+:\d+ in ([A-Za-z_]\w{0,60})$", re.MULTILINE)
