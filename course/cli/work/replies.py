"""The replies of the commands about an exercise."""

from typing import Annotated, Any

import msgspec

from course.catalog.models import CourseRef
from course.cli.frame.replies import Backup, Envelope, FileReply, NextStep, WrittenFile
from course.scoring.verdict import CheckResult


class CurveReply(msgspec.Struct, frozen=True):
    """Two curves that a failed check compared over time, the student's and the right one; at most 200 points.

    Attributes:
        check: its id.
        quantity, units: of both curves.
        right_is: what the right one is: "right", or the method that the step is named for.
        parts_at: when the student's curve leaves the right one, in s.
        description: the same as a sentence.
        t: times, in s.
        yours, right: values at these times.
    """

    check: str
    quantity: str
    units: str
    right_is: str
    parts_at: float
    description: str
    t: tuple[float, ...]
    yours: tuple[Any, ...]
    right: tuple[float, ...]


class Check(Envelope, tag="course.check/1", frozen=True, kw_only=True):
    """The verdict on one exercise. ``ok`` is "every check passes", ``passed`` is "reaches the pass mark".

    Attributes:
        printed: the file's output while it was loaded; output during a check is in that check's ``stdout``.
        curves: of failed checks that compared a motion along time, in the order of the tasks.
    """

    course: CourseRef
    exercise: str
    scope: str
    score: float
    max_score: float
    passed: bool
    checks: tuple[CheckResult, ...]
    next: NextStep | None = None
    warnings: tuple[str, ...] = ()
    printed: str = ""
    curves: tuple[CurveReply, ...] = ()


#: The two outcomes of a check. JSON tells them apart by their fields, msgspec does not.
CheckOrError = Annotated[
    Any,
    msgspec.Meta(extra_json_schema={"anyOf": [{"$ref": "#/$defs/Check"}, {"$ref": "#/$defs/ErrorReply"}]}),
]


class CheckAll(Envelope, tag="course.check-all/1", frozen=True, kw_only=True):
    refers_to = (Check,)

    results: tuple[CheckOrError, ...]


class WatchRun(msgspec.Struct, frozen=True):
    """One verdict of a watch. ``at`` is UTC; ``latency_ms`` runs from noticing the save to the verdict.

    ``exercise`` is the one that was checked: without a name, a watch goes from one to the next.
    """

    at: str
    state: str
    score: float
    max_score: float
    passed: bool
    latency_ms: float
    exercise: str = ""


class Watch(Envelope, tag="course.watch/1", frozen=True, kw_only=True):
    """Printed when the watch ends. ``exercise`` is the one that was watched last."""

    refers_to = (Check,)

    exercise: str
    runs: tuple[WatchRun, ...]
    last: CheckOrError | None = None


class ReflectPoint(msgspec.Struct, frozen=True):
    """A point to grade an answer by. ``grade`` is "yes", "partly", "no" or None."""

    text: str
    grade: str | None


class Reflect(Envelope, tag="course.reflect/1", frozen=True, kw_only=True):
    """A question for prose. ``good_answer`` and ``points`` come once there is an answer."""

    exercise: str
    question: str
    answer: str | None
    good_answer: str | None
    points: tuple[ReflectPoint, ...]
    next: NextStep | None = None


class Start(Envelope, tag="course.start/1", frozen=True, kw_only=True):
    exercise: str
    files: tuple[FileReply, ...]
    next: NextStep


class Hint(Envelope, tag="course.hint/1", frozen=True, kw_only=True):
    """``given`` is True if a new hint was shown; ``reason`` says why not otherwise.

    ``reason`` is one of "", "not_checked", "ungradable", "passing", "unchanged", "exhausted". ``hint`` is the
    new hint, or the last one again while the next is not due.
    """

    exercise: str
    given: bool
    reason: str
    task: str | None
    hint: str | None
    message: str
    next: NextStep


class Diff(Envelope, tag="course.diff/1", frozen=True, kw_only=True):
    exercise: str
    path: str
    changed: bool
    added: int
    removed: int
    diff: str


class Solution(Envelope, tag="course.solution/1", frozen=True, kw_only=True):
    """``source`` is the place of the solution; ``files`` maps file names to their text."""

    exercise: str
    source: str
    files: dict[str, str]


class Reset(Envelope, tag="course.reset/1", frozen=True, kw_only=True):
    exercise: str
    changed: bool
    backups: tuple[Backup, ...]
    next: NextStep


class Change(msgspec.Struct, frozen=True):
    """The action of ``update`` on one file.

    ``action`` is "replace" (it was never edited), "beside" (it was: the new one is at ``new``), "merge" (a
    notebook: newer text was put around the student's work), "current" (already so) or "missing" (removed by
    the student, and left so).
    """

    path: str
    action: str
    new: str | None = None
    backup: str | None = None


class Update(Envelope, tag="course.update/1", frozen=True, kw_only=True):
    dry_run: bool
    from_version: str
    to_version: str
    changes: tuple[Change, ...]


class SubmitFile(msgspec.Struct, frozen=True):
    """A file that goes in. ``last_score`` is what the public checks give these bytes; None if nothing."""

    path: str
    sha256: str
    bytes: int
    last_score: float | None = None
    max_score: float | None = None


class Submit(Envelope, tag="course.submit/1", frozen=True, kw_only=True):
    course: CourseRef
    output: str
    files: tuple[SubmitFile, ...]
    left_out: tuple[FileReply, ...]
    quiz_attempts: int = 0
    backup: str | None = None
    warnings: tuple[str, ...] = ()


class SectionReply(msgspec.Struct, frozen=True, kw_only=True):
    """One part of a report. ``figure`` is its file, ``description`` the figure in words."""

    title: str
    text: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    figure: WrittenFile | None
    description: str


class ReportReply(Envelope, tag="course.report/1", frozen=True, kw_only=True):
    course: CourseRef
    exercise: str
    title: str
    sections: tuple[SectionReply, ...]
    bag: str | None
