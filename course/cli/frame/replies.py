"""What ``--json`` prints, as types; scripts depend on every name here.

Each answer is one struct whose tag is its schema, ``course.<command>/1``. A field may be added within a
version; renaming, removing or changing the meaning of one makes a new version.
"""

from __future__ import annotations

import math
from typing import Any

import msgspec

from course.catalog.models import CourseRef
from course.scoring.verdict import CheckResult

__all__ = [
    "Backup",
    "Bare",
    "Change",
    "Check",
    "CheckAll",
    "Demo",
    "Diff",
    "Doctor",
    "Envelope",
    "ErrorBody",
    "ErrorReply",
    "ExerciseState",
    "FileReply",
    "Fix",
    "Help",
    "Hint",
    "Init",
    "LessonReply",
    "LessonState",
    "Lessons",
    "NextStep",
    "Package",
    "Progress",
    "QuizState",
    "Reset",
    "Solution",
    "Start",
    "Status",
    "Submit",
    "SubmitFile",
    "Update",
    "Version",
    "Watch",
    "WatchRun",
    "WrittenFile",
    "encode",
]


class NextStep(msgspec.Struct, frozen=True):
    """The command to run next."""

    command: str


class ErrorBody(msgspec.Struct, frozen=True):
    """A stable code, what is the case, and what to do about it."""

    code: str
    message: str
    help: str = ""


class Envelope(msgspec.Struct, frozen=True, kw_only=True, tag_field="schema"):
    """What every answer begins with."""

    ok: bool = True
    exit_code: int = 0


class ErrorReply(msgspec.Struct, frozen=True, kw_only=True):
    """The answer of a command that could not do its work; its schema is the command's own."""

    schema: str
    ok: bool = False
    exit_code: int
    error: ErrorBody


class Version(Envelope, tag="course.version/1", frozen=True, kw_only=True):
    version: str
    python: str


class Help(Envelope, tag="course.help/1", frozen=True, kw_only=True):
    text: str


class Bare(msgspec.Struct, frozen=True, kw_only=True):
    """The answer of a command that had nothing to report beyond its exit code."""

    schema: str
    ok: bool
    exit_code: int


class Check(Envelope, tag="course.check/1", frozen=True, kw_only=True):
    """The verdict on one exercise. ``ok`` is "every check passes", ``passed`` is "reaches the pass mark"."""

    course: CourseRef
    exercise: str
    scope: str
    score: float
    max_score: float
    passed: bool
    checks: tuple[CheckResult, ...]
    next: NextStep | None = None
    warnings: tuple[str, ...] = ()


class CheckAll(Envelope, tag="course.check-all/1", frozen=True, kw_only=True):
    results: tuple[Check | ErrorReply, ...]


class Demo(Envelope, tag="course.demo/1", frozen=True, kw_only=True):
    """An untouched stub and a finished example, checked the same way."""

    stub: Check
    worked: Check


class WatchRun(msgspec.Struct, frozen=True):
    """One verdict of a watch. ``at`` is UTC; ``latency_ms`` runs from noticing the save to the verdict."""

    at: str
    state: str
    score: float
    max_score: float
    passed: bool
    latency_ms: float


class Watch(Envelope, tag="course.watch/1", frozen=True, kw_only=True):
    """Printed when the watch ends."""

    exercise: str
    runs: tuple[WatchRun, ...]
    last: Check | ErrorReply | None = None


class ExerciseState(msgspec.Struct, frozen=True, kw_only=True):
    """One exercise and how far the student is. Scores are public points of the last and the best check."""

    id: str
    title: str
    summary: str
    lesson: str
    state: str
    score: float | None = None
    max_score: float | None = None
    best_score: float | None = None
    checks_run: int = 0
    hints_shown: int = 0
    started_at: str | None = None
    checked_at: str | None = None
    passed_at: str | None = None


class LessonState(msgspec.Struct, frozen=True, kw_only=True):
    id: str
    title: str
    summary: str
    minutes: int
    exercises: tuple[str, ...]
    read_at: str | None = None


class QuizState(msgspec.Struct, frozen=True):
    """The quiz so far: the attempts that count, and the best of them; None before the first."""

    attempts: int
    best: int | None
    total: int
    passed: bool


class Status(Envelope, tag="course.status/1", frozen=True, kw_only=True):
    """The dashboard. ``workspace`` is None outside of one."""

    course: CourseRef
    title: str
    workspace: str | None
    lessons_read: int
    lessons: int
    exercises: tuple[ExerciseState, ...]
    next: NextStep
    quiz: QuizState | None = None
    warnings: tuple[str, ...] = ()


class Progress(Envelope, tag="course.progress/1", frozen=True, kw_only=True):
    course: CourseRef
    workspace: str
    lessons: tuple[LessonState, ...]
    exercises: tuple[ExerciseState, ...]
    submissions: tuple[str, ...]
    next: NextStep
    quiz: QuizState | None = None


class Lessons(Envelope, tag="course.lessons/1", frozen=True, kw_only=True):
    lessons: tuple[LessonState, ...]
    next: NextStep | None = None


class LessonReply(Envelope, tag="course.lesson/1", frozen=True, kw_only=True):
    """One lesson; ``text`` is what ``--plain`` shows, or with ``--code`` the code of one cell."""

    id: str
    title: str
    minutes: int
    objectives: tuple[str, ...]
    exercises: tuple[str, ...]
    text: str
    figures: tuple[str, ...] = ()
    next: NextStep | None = None


class Init(Envelope, tag="course.init/1", frozen=True, kw_only=True):
    """``created`` is False where the folder was a workspace already; nothing was changed then."""

    workspace: str
    created: bool
    course: CourseRef
    next: NextStep


class FileReply(msgspec.Struct, frozen=True):
    """A file and what was done about it."""

    path: str
    action: str


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
    """``source`` is where it was found; ``files`` maps file names to their text."""

    exercise: str
    source: str
    files: dict[str, str]


class Backup(msgspec.Struct, frozen=True):
    """A file that was replaced and where its copy is."""

    path: str
    backup: str


class WrittenFile(msgspec.Struct, frozen=True):
    """A file that was written, and the copy of what was there before."""

    path: str
    backup: Backup | None = None


class Reset(Envelope, tag="course.reset/1", frozen=True, kw_only=True):
    exercise: str
    changed: bool
    backups: tuple[Backup, ...]
    next: NextStep


class Change(msgspec.Struct, frozen=True):
    """What ``update`` does about one file.

    ``action`` is "replace" (it was never edited), "beside" (it was: the new one is at ``new``), "current"
    (already so) or "missing" (removed by the student, and left so).
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
    """A file that goes in. ``last_score`` is of the last check; None if it changed since or never ran."""

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


class Package(msgspec.Struct, frozen=True):
    """A requirement and what is installed for it; ``group`` is "" or the name of the extra."""

    name: str
    requirement: str
    installed: str | None
    ok: bool
    group: str = ""


class Fix(msgspec.Struct, frozen=True):
    """Something that is missing and the command that installs it."""

    problem: str
    command: str


class Doctor(Envelope, tag="course.doctor/1", frozen=True, kw_only=True):
    course: CourseRef
    python: str
    platform: str
    installation: str
    packages: tuple[Package, ...]
    protection: str
    protection_causes: tuple[str, ...]
    protection_advice: tuple[str, ...]
    terminal: dict[str, str]
    workspace: str | None
    repaired: str | None
    fixes: tuple[Fix, ...]


def encode(body: msgspec.Struct) -> bytes:
    """``body`` as one line of JSON in UTF-8; numbers that JSON has not are "nan", "inf" and "-inf"."""
    return msgspec.json.encode(_finite(msgspec.to_builtins(body)))


def _finite(value: Any) -> Any:
    if isinstance(value, float) and not math.isfinite(value):
        return "nan" if math.isnan(value) else ("inf" if value > 0 else "-inf")
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(item) for item in value]
    return value
