"""Rules for a course file beyond the right keys and types.

Each rule raises the ContentError that points at the line. Rules about one file live here; what takes two
files to see (links, points, signatures) is the audit's.
"""

from __future__ import annotations

import math
import re
import sys
from typing import TYPE_CHECKING, Any

from course.catalog.models import fields_of
from course.errors import UsageError
from course.ids import WARM_UPS, ExerciseId, LessonId

if TYPE_CHECKING:
    from course.catalog.models import Exercise, Hints, Lesson, MutantList, Rubric, Syllabus
    from course.catalog.reading import Document

__all__ = [
    "check_exercise",
    "check_hints",
    "check_lesson",
    "check_mutants",
    "check_rubric",
    "check_syllabus",
]

_MODULE = re.compile(r"[a-z][a-z0-9_]*\.py")
_COURSE_ID = re.compile(r"[a-z][a-z0-9]*(?:-[a-z0-9]+)*")
#: A warm-up is done within one sitting with its lesson. In minutes.
MOST_MINUTES = 15
#: Names that have a role in the exercise's folder.
_TAKEN_MODULES = {"checks.py", "questions.py", "report.py"}


def check_syllabus(document: Document[Syllabus]) -> None:
    """Ids are well formed and no lesson is listed twice."""
    syllabus = document.value
    if not _COURSE_ID.fullmatch(syllabus.id):
        document.fail(("id",), "`id` is not lower-case words joined by hyphens.", fix="Write: physics-sim")
    _check_words(document, ("title",), syllabus.title)
    for index, lesson_id in enumerate(syllabus.lessons):
        _check_id(document, ("lessons", index), lesson_id, LessonId)
        if lesson_id in syllabus.lessons[:index]:
            document.fail(
                ("lessons", index), f"lesson {lesson_id} is listed twice.", fix="Remove one of the two lines."
            )


def check_lesson(document: Document[Lesson]) -> None:
    """The head of a lesson fits its file name and says something."""
    lesson = document.value
    _check_id(document, ("id",), lesson.id, LessonId)
    if lesson.id != document.path.stem:
        document.fail(
            ("id",),
            f"`id` is {lesson.id}, and the file is called {document.path.name}.",
            fix=f'Write `id = "{document.path.stem}"`, or rename the file {lesson.id}.md.',
        )
    _check_words(document, ("title",), lesson.title)
    _check_words(document, ("summary",), lesson.summary)
    if lesson.minutes <= 0:
        document.fail(("minutes",), "`minutes` must be more than 0.", fix="Say how long reading it takes.")
    if not lesson.objectives:
        document.fail(
            ("objectives",),
            "`objectives` is empty.",
            fix="Say what a reader can do afterwards, one line each.",
        )
    for index, objective in enumerate(lesson.objectives):
        _check_words(document, ("objectives", index), objective)
    for key, ids in (("before", lesson.before), ("exercises", lesson.exercises)):
        for index, name in enumerate(ids):
            _check_id(document, (key, index), name, LessonId if key == "before" else ExerciseId)


def check_exercise(document: Document[Exercise]) -> None:
    """Names, marks and points of an exercise make sense by themselves."""
    exercise = document.value
    folder = document.path.parent.name
    _check_id(document, ("id",), exercise.id, ExerciseId)
    if exercise.id != folder:
        document.fail(
            ("id",),
            f"`id` is {exercise.id}, and the folder is called {folder}.",
            fix=f'Write `id = "{folder}"`, or rename the folder.',
        )
    _check_words(document, ("title",), exercise.title)
    _check_words(document, ("summary",), exercise.summary)
    _check_id(document, ("lesson",), exercise.lesson, LessonId)
    _check_module(document, exercise.module)
    _check_kind(document)
    if exercise.order < 1:
        document.fail(("order",), "`order` must be 1 or more.", fix="Number the exercises from 1.")
    if not 0 < exercise.pass_mark <= 1:
        document.fail(
            ("pass_mark",),
            "`pass_mark` must be a share of the points, above 0 and at most 1.",
            fix="Write 0.70 for 70 %.",
        )
    for index, name in enumerate(exercise.imports):
        if not name.isidentifier():
            document.fail(
                ("imports", index),
                f"{name!r} is not a top-level package.",
                fix='Name packages alone: "numpy".',
            )
        if name in sys.stdlib_module_names:
            document.fail(
                ("imports", index),
                f"{name!r} is part of Python, all of which may be imported anyway.",
                fix="Take it out.",
            )
    _check_tasks(document)


def _check_kind(document: Document[Exercise]) -> None:
    """A warm-up lies with the warm-ups, and everything there is one."""
    exercise = document.value
    lies_there = document.path.parent.parent.name == WARM_UPS
    if exercise.is_warm_up is not lies_there:
        where, kind = ("lies", "exercise") if lies_there else ("does not lie", "warm-up")
        document.fail(
            ("kind",),
            f"`kind` is {kind}, and the folder {where} in {WARM_UPS}.",
            fix=f'Write `kind = "warm-up"` for what lies in {WARM_UPS}, and for nothing else.',
        )
    if exercise.is_warm_up and not 0 < exercise.minutes <= MOST_MINUTES:
        document.fail(
            ("minutes",),
            f"`minutes` of a warm-up lie between 1 and {MOST_MINUTES}.",
            fix="Say how long it takes; what takes longer is an exercise.",
        )


def _check_module(document: Document[Exercise], module: str) -> None:
    if not _MODULE.fullmatch(module):
        document.fail(
            ("module",),
            f"`module` is {module!r}, which is not a plain Python file name.",
            fix="Use lower-case letters, digits and underscores, then .py: sim_to_real.py",
        )
    if module in _TAKEN_MODULES:
        document.fail(("module",), f"{module} already has another role here.", fix="Choose another name.")


def _check_tasks(document: Document[Exercise]) -> None:
    exercise = document.value
    if not exercise.task:
        document.fail(("task",), "there is no task.", fix="Add a [[task]] for each function to write.")
    for index, task in enumerate(exercise.task):
        if not task.id.isidentifier():
            document.fail(
                ("task", index, "id"),
                f"{task.id!r} is not a Python name.",
                fix="The id of a task is the name of the function the student writes.",
            )
        if any(other.id == task.id for other in exercise.task[:index]):
            document.fail(
                ("task", index, "id"), f"task {task.id} is listed twice.", fix="Remove or rename one of them."
            )
        _check_words(document, ("task", index, "title"), task.title)
        if not (math.isfinite(task.points) and task.points > 0):
            document.fail(
                ("task", index, "points"),
                f"`points` of {task.id} must be a number above 0.",
                fix="Give the points of its public and hidden checks together.",
            )
    _check_hidden(document)


def _check_hidden(document: Document[Exercise]) -> None:
    exercise = document.value
    if exercise.hidden_checks < 0:
        document.fail(("hidden_checks",), "`hidden_checks` is negative.", fix="Count the hidden checks.")
    if not 0 <= exercise.hidden_points <= exercise.max_points:
        document.fail(
            ("hidden_points",),
            "`hidden_points` must lie between 0 and the sum of the tasks' points.",
            fix="Add up the points of the hidden checks.",
        )


def check_hints(document: Document[Hints], exercise: Exercise) -> None:
    """Hints belong to tasks that exist, once each, and are not empty."""
    tasks = [task.id for task in exercise.task]
    seen: set[str] = set()
    for index, entry in enumerate(document.value.task):
        if entry.id not in tasks:
            document.fail(
                ("task", index, "id"),
                f"exercise {exercise.id} has no task {entry.id!r}.",
                fix=f"Its tasks are {', '.join(tasks)}.",
            )
        if entry.id in seen:
            document.fail(
                ("task", index, "id"),
                f"task {entry.id} has hints twice.",
                fix="Put all its hints into one list.",
            )
        seen.add(entry.id)
        for number, hint in enumerate(entry.hints):
            _check_words(document, ("task", index, "hints", number), hint)
        for fitting in entry.fits:
            if fitting not in map(str, range(1, len(entry.hints) + 1)):
                document.fail(
                    ("task", index, "fits"),
                    f"task {entry.id} has no hint number {fitting}.",
                    fix=f"Its hints are 1 to {len(entry.hints)}.",
                )
        for told, sentences in entry.yours.items():
            where = ("task", index, "yours", told)
            if told not in ("any", *map(str, range(1, len(entry.hints) + 1))):
                document.fail(
                    where,
                    f"task {entry.id} has no hint number {told}.",
                    fix=f"Its hints are 1 to {len(entry.hints)}, or any.",
                )
            for sentence in sentences:
                if not fields_of(sentence):
                    document.fail(
                        where,
                        f"a sentence about the student's numbers has no field: {sentence!r}.",
                        fix="Name one, such as {got}, or make the sentence a part of the hint.",
                    )


def check_rubric(document: Document[Rubric]) -> None:
    """There is a question, something to grade by, and an answer that is long enough itself."""
    rubric = document.value
    _check_words(document, ("question",), rubric.question.strip())
    for index, point in enumerate(rubric.points):
        _check_words(document, ("points", index), point)
    if not rubric.points:
        document.fail(("points",), "there is nothing to grade an answer by.", fix="Add a sentence or more.")
    if len(rubric.good_answer.split()) < max(1, rubric.least_words):
        document.fail(
            ("good_answer",),
            f"the good answer has fewer than {max(1, rubric.least_words)} words.",
            fix="Make it longer, or `least_words` smaller.",
        )


def check_mutants(document: Document[MutantList], exercise: Exercise) -> None:
    """Mutants name plain files, once each, and tasks that exist."""
    tasks = [task.id for task in exercise.task]
    files: set[str] = set()
    for index, mutant in enumerate(document.value.mutant):
        where = ("mutant", index)
        if not _MODULE.fullmatch(mutant.file):
            document.fail(
                (*where, "file"),
                f"{mutant.file!r} is not a plain Python file name.",
                fix="Write: wrong_sign.py",
            )
        if mutant.file in files:
            document.fail((*where, "file"), f"{mutant.file} is listed twice.", fix="Remove one entry.")
        files.add(mutant.file)
        if mutant.task not in tasks:
            document.fail(
                (*where, "task"),
                f"exercise {exercise.id} has no task {mutant.task!r}.",
                fix=f"Its tasks are {', '.join(tasks)}.",
            )
        for key in ("misconception", "check", "diagnosis"):
            _check_words(document, (*where, key), getattr(mutant, key))


def _check_words(document: Document[Any], where: tuple[str | int, ...], text: str) -> None:
    if not text.strip():
        name = next(str(step) for step in reversed(where) if isinstance(step, str))
        document.fail(where, f"`{name}` is empty.", fix="Fill it in.")


def _check_id(
    document: Document[Any],
    where: tuple[str | int, ...],
    text: str,
    kind: type[ExerciseId] | type[LessonId],
) -> None:
    try:
        kind(text)
    except UsageError as error:
        document.fail(where, error.message, fix=error.help)
