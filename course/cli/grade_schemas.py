"""What ``course grade --json`` prints beside ``course.grade/1``, which the exports define."""

from __future__ import annotations

import msgspec

from course.cli.schemas import Envelope

__all__ = ["GradeSummary", "Trouble"]


class Trouble(msgspec.Struct, frozen=True):
    """One submission without a grade."""

    student: str
    exercise: str
    code: str
    message: str


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
