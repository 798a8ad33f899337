"""What ``course grade --json`` prints beside ``course.grade/1``, which the exports define."""

from __future__ import annotations

import msgspec

from course.cli.frame.replies import Envelope
from course.grading.running.rerun import Change
from course.grading.running.run import Trouble

__all__ = ["GradeExport", "GradeLate", "GradeRerun", "GradeSimilar", "GradeSummary", "LateOne", "SimilarPair"]


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
    unrecognised: tuple[str, ...] = ()
    missing: tuple[str, ...] = ()
    strangers: tuple[str, ...] = ()


class GradeRerun(Envelope, tag="course.grade-rerun/1", frozen=True, kw_only=True):
    """Who changes, or changed, by how much and by which check."""

    dry_run: bool
    regraded: int
    up_to_date: int
    kept: int
    grader_error: int
    changes: tuple[Change, ...]


class LateOne(msgspec.Struct, frozen=True, kw_only=True):
    """One result that is late, or flagged so. Seconds and points."""

    student: str
    exercise: str
    late: float | None
    penalty: float
    submitted_at: str | None
    witness: str
    flagged_late: bool


class GradeLate(Envelope, tag="course.grade-late/1", frozen=True, kw_only=True):
    """Who is late under the policy in force; ``time_unknown`` counts results nobody trusted dates."""

    policy: bool
    late: tuple[LateOne, ...]
    time_unknown: int
    unknown_names: tuple[str, ...]


class GradeExport(Envelope, tag="course.grade-export/1", frozen=True, kw_only=True):
    """What was written. ``unmatched`` are students the roster has not, left out with ``--partial``."""

    format: str
    paths: tuple[str, ...]
    rows: int
    unmatched: tuple[str, ...]
    without_grade: tuple[str, ...]
    notes: tuple[str, ...]


class SimilarPair(msgspec.Struct, frozen=True, kw_only=True):
    """Two submissions of one exercise; ``share`` of the smaller one is in the other."""

    exercise: str
    first: str
    second: str
    share: float
    lines: int


class GradeSimilar(Envelope, tag="course.grade-similar/1", frozen=True, kw_only=True):
    """Pairs, the most alike first; the page shows them side by side."""

    compared: int
    pairs: tuple[SimilarPair, ...]
    unreadable: tuple[str, ...]
    page: str
