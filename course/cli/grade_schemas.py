"""What ``course grade --json`` prints beside ``course.grade/1``, which the exports define."""

from __future__ import annotations

from course.cli.schemas import Envelope
from course.grading.run import Trouble  # noqa: TC001 - the type of a field

__all__ = ["GradeSummary"]


class GradeSummary(Envelope, tag="course.grade-summary/1", frozen=True, kw_only=True):
    """The last line of ``grade run``: counts over the whole gradebook."""

    graded: int
    ungradable: int
    grader_error: int
    passed: int
    not_submitted: int
    already_graded: int
    isolation: dict[str, int]
    seed: int
    elapsed_s: float
    out: str
    troubled: tuple[Trouble, ...]
