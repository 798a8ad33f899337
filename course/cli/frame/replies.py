"""What ``--json`` prints, as types; scripts depend on every name here.

Each answer is one struct whose tag is its schema, ``course.<command>/1``. A field may be added within a
version; renaming, removing or changing the meaning of one makes a new version.
"""

from __future__ import annotations

import math
from typing import Annotated, Any

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
    "Exercises",
    "FileReply",
    "Fix",
    "Go",
    "Help",
    "Hint",
    "Init",
    "LessonReply",
    "LessonState",
    "Lessons",
    "Next",
    "NextStep",
    "ObjectiveState",
    "Package",
    "Progress",
    "QuizState",
    "Reflect",
    "ReflectPoint",
    "Reset",
    "Schema",
    "Schemas",
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


class Schemas(Envelope, tag="course.schema-list/1", frozen=True, kw_only=True):
    """Which schemas there are."""

    schemas: tuple[str, ...]


class Schema(Envelope, tag="course.schema/1", frozen=True, kw_only=True):
    """The JSON Schema of one kind of reply."""

    name: str
    document: dict[str, Any]


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


#: What a check ended in. JSON tells the two apart by their fields, msgspec does not.
CheckOrError = Annotated[
    Any,
    msgspec.Meta(extra_json_schema={"anyOf": [{"$ref": "#/$defs/Check"}, {"$ref": "#/$defs/ErrorReply"}]}),
]


class CheckAll(Envelope, tag="course.check-all/1", frozen=True, kw_only=True):
    results: tuple[CheckOrError, ...]


class Demo(Envelope, tag="course.demo/2", frozen=True, kw_only=True):
    """A worked example with a mistake, and mended.

    ``change`` is the mended line as a diff. ``energy`` is the energy of each motion in units of its energy at
    the start: the least and the most over ``steps`` steps of ``step_size`` seconds.
    """

    before: Check
    after: Check
    change: tuple[str, ...]
    steps: int
    step_size: float
    energy_before: tuple[float, float]
    energy_after: tuple[float, float]


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
    last: CheckOrError | None = None


class ExerciseState(msgspec.Struct, frozen=True, kw_only=True):
    """One exercise and how far the student is. Scores are public points of the last and the best check."""

    id: str
    title: str
    summary: str
    lesson: str
    state: str
    #: The number it has in the chapter; None if it is not the chapter's.
    number: int | None = None
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


class WarmUpState(msgspec.Struct, frozen=True, kw_only=True):
    """One warm-up. ``state`` is "new", "started" or "done": all its checks passed once."""

    id: str
    title: str
    summary: str
    lesson: str
    minutes: int
    state: str
    checks_run: int = 0
    hints_shown: int = 0
    done_at: str | None = None


class QuizState(msgspec.Struct, frozen=True):
    """The quiz so far: the attempts that count, and the best of them; None before the first."""

    attempts: int
    best: int | None
    total: int
    passed: bool


class ReflectPoint(msgspec.Struct, frozen=True):
    """Something to grade an answer by. ``grade`` is "yes", "partly", "no" or None."""

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


class ObjectiveState(msgspec.Struct, frozen=True, kw_only=True):
    """A learning objective and the evidence for it.

    ``predictions`` counts those that were made, not skipped. ``passed`` names its exercises whose pass mark
    was reached at home, ``answered`` its quiz questions answered rightly in a finished attempt.
    """

    title: str
    lessons: tuple[str, ...]
    lessons_read: tuple[str, ...]
    predictions: int
    warm_ups: int
    warm_ups_done: int
    exercises: tuple[str, ...]
    passed: tuple[str, ...]
    questions: tuple[str, ...]
    answered: tuple[str, ...]


class Next(Envelope, tag="course.next/1", frozen=True, kw_only=True):
    """The next step; ``why`` says what it is."""

    next: NextStep
    why: str


class Go(Envelope, tag="course.go/1", frozen=True, kw_only=True):
    """The step that would be run; a run in a terminal prints what its command prints."""

    next: NextStep
    why: str


class Exercises(Envelope, tag="course.exercises/1", frozen=True, kw_only=True):
    """In the order in which the lessons lead to them. ``workspace`` is None outside of one."""

    workspace: str | None
    exercises: tuple[ExerciseState, ...]
    next: NextStep | None = None


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
    objectives: tuple[ObjectiveState, ...] = ()
    warnings: tuple[str, ...] = ()


class PredictionState(msgspec.Struct, frozen=True, kw_only=True):
    """A prediction in a lesson. ``said`` is None if it was skipped.

    ``judged`` is "right", "nearly" or "wrong", by the student's own word; None before. ``section`` is
    "lesson#section"; it and ``question`` are "" if the lesson does not ask this any more.
    """

    lesson: str
    section: str
    question: str
    said: str | None
    judged: str | None
    at: str


class PredictionsOf(msgspec.Struct, frozen=True, kw_only=True):
    """Predictions counted: of a lesson, of a day (local time) or of all. ``said`` leaves out skipped ones."""

    of: str
    said: int
    right: int
    nearly: int
    wrong: int
    unjudged: int
    skipped: int


class PredictionsState(msgspec.Struct, frozen=True, kw_only=True):
    """What was predicted in lessons, and how well."""

    all: PredictionsOf
    by_lesson: tuple[PredictionsOf, ...]
    by_day: tuple[PredictionsOf, ...]
    each: tuple[PredictionState, ...]


class MistakeState(msgspec.Struct, frozen=True, kw_only=True):
    """A mistake that checks recognised. ``read`` is where it is explained, as "lesson#section" or "lesson".

    ``mended_at`` is None while a check that showed it has not passed since; ``looks_like`` is "" where the
    exercise keeps no words for the code.
    """

    exercise: str
    task: str
    title: str
    diagnosis: str
    looks_like: str
    read: str
    first_seen: str
    last_seen: str
    runs: int
    mended_at: str | None


class Revisit(msgspec.Struct, frozen=True, kw_only=True):
    """A section to read again: open mistakes point at it, or predictions in it were wrong."""

    lesson: str
    section: str
    title: str
    why: tuple[str, ...]
    command: str


class Progress(Envelope, tag="course.progress/1", frozen=True, kw_only=True):
    course: CourseRef
    workspace: str
    lessons: tuple[LessonState, ...]
    exercises: tuple[ExerciseState, ...]
    submissions: tuple[str, ...]
    next: NextStep
    quiz: QuizState | None = None
    warm_ups: tuple[WarmUpState, ...] = ()
    predictions: PredictionsState | None = None
    mistakes: tuple[MistakeState, ...] = ()
    revisit: tuple[Revisit, ...] = ()


class WarmUps(Envelope, tag="course.warmup/1", frozen=True, kw_only=True):
    """The warm-ups, in the order of the lessons. With an id the answer is that of ``start`` or ``check``."""

    warm_ups: tuple[WarmUpState, ...]
    next: NextStep | None = None


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
    files: tuple[WrittenFile, ...] = ()


class Bug(Envelope, tag="course.bug/1", frozen=True, kw_only=True):
    """A report for whoever looks for a fault; ``traceback`` is False where no crash was found."""

    file: WrittenFile
    traceback: bool


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
    unserved: tuple[str, ...] = ()


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
