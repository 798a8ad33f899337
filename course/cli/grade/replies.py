"""The replies of ``course grade --json``, except ``course.grade/1``, which the exports define."""

import msgspec

from course.cli.frame.replies import Envelope
from course.grading.gradebook.records import Decision, Run
from course.grading.results.effective import ScoreChange
from course.grading.running.rerun import Change
from course.grading.running.run import Ungraded


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
    troubled: tuple[Ungraded, ...]
    unrecognised: tuple[str, ...] = ()
    missing: tuple[str, ...] = ()
    strangers: tuple[str, ...] = ()
    unjudged: tuple[str, ...] = ()
    graders: str = ""
    edited: tuple[str, ...] = ()
    would_change: tuple[Change, ...] = ()
    unsettled: int = 0
    moved: tuple[ScoreChange, ...] = ()
    dropped: tuple[str, ...] = ()


class GradeRerun(Envelope, tag="course.grade-rerun/1", frozen=True, kw_only=True):
    """The students whose scores change, by how much, and because of which check."""

    dry_run: bool
    regraded: int
    up_to_date: int
    kept: int
    grader_error: int
    changes: tuple[Change, ...]
    graders: str = ""


class AssignedOne(msgspec.Struct, frozen=True, kw_only=True):
    """A file that became a student's submission; null scores do not count."""

    student: str
    exercise: str
    file: str
    score_before: float | None
    score_after: float | None
    state_before: str
    state_after: str


class FoundFile(msgspec.Struct, frozen=True, kw_only=True):
    """A file that may be meant for an exercise, and which of its functions it defines.

    ``kind`` says what it is, or why it cannot be read; it is empty for a .py file or a notebook.
    """

    file: str
    defines: tuple[str, ...]
    proposed: bool
    kind: str = ""


class UnsettledOne(msgspec.Struct, frozen=True, kw_only=True):
    """Work that could not be graded; ``reason`` is the code of the problem, ``message`` says it in words."""

    student: str
    exercise: str
    reason: str
    message: str
    files: tuple[FoundFile, ...]


class GradeAssign(Envelope, tag="course.grade-assign/1", frozen=True, kw_only=True):
    """The assigned files, and the cases that are left."""

    dry_run: bool
    assigned: tuple[AssignedOne, ...]
    unsettled: tuple[UnsettledOne, ...]


class GradeLog(Envelope, tag="course.grade-log/1", frozen=True, kw_only=True):
    """Every run, and every change of a grade."""

    runs: tuple[Run, ...]
    changes: tuple[Decision, ...]


class GradeSalvage(Envelope, tag="course.grade-salvage/1", frozen=True, kw_only=True):
    """Rows by table, the number that only a backup had, and the known losses."""

    dry_run: bool
    rows: dict[str, int]
    from_backup: dict[str, int]
    lost: tuple[str, ...]
    out: str


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
    """The late results under the present policy; ``time_unknown`` counts results without a trusted date."""

    policy: bool
    late: tuple[LateOne, ...]
    time_unknown: int
    unknown_names: tuple[str, ...]
    dry_run: bool = False
    moved: tuple[ScoreChange, ...] = ()
    dropped: tuple[str, ...] = ()


class GradeExport(Envelope, tag="course.grade-export/1", frozen=True, kw_only=True):
    """The export. ``unmatched`` are students without a row in the roster, left out with ``--partial``.

    ``moved`` are the scores that a second roster changed, ``dropped`` the students whom it does not have,
    ``kept`` rows of the platform's file that have a teacher's grade, feedback or excuse.
    """

    format: str
    paths: tuple[str, ...]
    rows: int
    unmatched: tuple[str, ...]
    without_grade: tuple[str, ...]
    notes: tuple[str, ...]
    moved: tuple[ScoreChange, ...] = ()
    dropped: tuple[str, ...] = ()
    kept: tuple[str, ...] = ()


class SimilarPair(msgspec.Struct, frozen=True, kw_only=True):
    """Two submissions of one exercise; ``share`` of the smaller one is in the other."""

    exercise: str
    first: str
    second: str
    share: float
    lines: int


class SimilarGroup(msgspec.Struct, frozen=True, kw_only=True):
    """Submissions of one exercise that similar pairs link; ``share`` is that of the weakest pair."""

    exercise: str
    members: tuple[str, ...]
    share: float


class GradeSimilar(Envelope, tag="course.grade-similar/1", frozen=True, kw_only=True):
    """Pairs, the most alike first, and groups, the largest first; the page shows the pairs side by side."""

    compared: int
    pairs: tuple[SimilarPair, ...]
    groups: tuple[SimilarGroup, ...]
    unreadable: tuple[str, ...]
    page: str
