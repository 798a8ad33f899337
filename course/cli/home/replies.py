"""Replies of `course`, `course progress` and `course next`."""

import msgspec

from course.catalog.models import CourseRef
from course.cli.frame.replies import Envelope, NextStep


class ExerciseState(msgspec.Struct, frozen=True, kw_only=True):
    """One exercise and how far the student is. Scores are public points of the last and the best check."""

    id: str
    title: str
    summary: str
    lesson: str
    state: str
    #: What commands call it by: its place in the order in which the lessons lead to the exercises, from 1.
    number: int
    #: The number it has in the chapter; None if it is not the chapter's.
    chapter: int | None = None
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
    """One warm-up. ``state`` is "new", "started" or "done": all its checks passed once.

    ``number`` is its place in the order of the lessons, from 1; commands take it.
    """

    id: str
    title: str
    summary: str
    lesson: str
    minutes: int
    state: str
    number: int
    checks_run: int = 0
    hints_shown: int = 0
    done_at: str | None = None


class QuizState(msgspec.Struct, frozen=True):
    """The quiz so far: the attempts that count, and the best of them; None before the first."""

    attempts: int
    best: int | None
    total: int
    passed: bool


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


class Exercises(Envelope, tag="course.exercises/2", frozen=True, kw_only=True):
    """In the order in which the lessons lead to them. ``workspace`` is None outside of one."""

    workspace: str | None
    exercises: tuple[ExerciseState, ...]
    next: NextStep | None = None


class Status(Envelope, tag="course.status/2", frozen=True, kw_only=True):
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
    """The predictions in lessons, and how good they were."""

    all: PredictionsOf
    by_lesson: tuple[PredictionsOf, ...]
    by_day: tuple[PredictionsOf, ...]
    each: tuple[PredictionState, ...]


class MistakeState(msgspec.Struct, frozen=True, kw_only=True):
    """A mistake that checks recognised. ``read`` is where it is explained, as "lesson#section" or "lesson".

    ``given`` is True in a program that is handed out with faults.
    ``mended_at`` is None while a check that showed it has not passed since; ``named`` is True while the
    newest run of such a check shows it. ``looks_like`` names the exception if the code is RAISED; else it is
    "" where the exercise keeps no words for the code.
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
    named: bool = False
    given: bool = False


class Revisit(msgspec.Struct, frozen=True, kw_only=True):
    """A section to read again: mistakes that are still named point at it, or predictions in it were wrong."""

    lesson: str
    section: str
    title: str
    why: tuple[str, ...]
    command: str


class Progress(Envelope, tag="course.progress/2", frozen=True, kw_only=True):
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
