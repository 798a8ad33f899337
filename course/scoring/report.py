"""An exercise's report on a student's own code: text, tables and figures on public data.

An exercise that has something to show ships ``report.py`` with a function ``report(submission)``. It calls
the student's functions through the same boundary as the checks do.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from course.isolation.failures import StudentFailure
from course.scoring.failures import CheckFailed, finding_of
from course.scoring.verdict import Finding

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from course.figures.drawing.described import Plot

__all__ = ["Report", "Section", "finding_for", "guarded_section"]


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
        streams: recorded sensor streams by kind, for a ROS 2 bag.
    """

    title: str
    sections: tuple[Section, ...]
    streams: Mapping[str, Any] = field(default_factory=dict)


def guarded_section(title: str, make: Callable[[], Section]) -> Section:
    """The section that ``make()`` returns, or what went wrong if the student's code fails."""
    try:
        return make()
    except (StudentFailure, CheckFailed) as failure:
        finding = finding_for(failure)
        return Section(title, "\n\n".join(part for part in (finding.message, finding.help) if part))


def finding_for(failure: StudentFailure | CheckFailed) -> Finding:
    """The failure in words; it names a function that is still to be written.

    A check does not name it, because a name could reveal hidden inputs. A report has no hidden inputs.
    """
    if isinstance(failure, CheckFailed):
        return failure.finding
    finding = finding_of(failure, shown=True)
    functions = _FRAME.findall(failure.traceback)
    if failure.is_a("NotImplementedError") and functions:
        message = f"`{functions[-1]}` is not written yet: it still raises NotImplementedError."
        return Finding(message=message, help=finding.help, diagnosis=finding.diagnosis)
    return finding


#: The function of a line of a traceback, as ``StudentFailure`` has it: "file.py:12 in name".
_FRAME = re.compile(r"^\S+:\d+ in ([A-Za-z_]\w{0,60})$", re.MULTILINE)
