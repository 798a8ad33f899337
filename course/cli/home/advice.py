"""Which command to suggest next."""

from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

from course.catalog.load import Catalog
from course.catalog.models import Exercise, Lesson
from course.cli.frame.here import Here
from course.errors import CourseError
from course.handed_in.attempts import Attempt
from course.progress.history import Standing, fingerprint
from course.scoring.verdict import format_points, in_points


def next_step(here: Here, made: Attempt) -> str:
    """After a check: hand in, take a hint if one is due, or go on working."""
    exercise = made.exercise
    if made.verdict.all_pass:
        return after_warm_up(here, exercise) if exercise.is_warm_up else "course submit"
    if fingerprint(made.source) == fingerprint(here.stub(exercise)):  # before anything is written
        unread = False
        with suppress(CourseError):  # a warm-up is done while its lesson is read
            unread = not exercise.is_warm_up and exercise.lesson not in here.standing().read
        return f"course lesson {exercise.lesson}" if unread else f"course watch {exercise.id}"
    return f"course {'hint' if hint_is_due(here, exercise) else 'watch'} {exercise.id}"


def hint_is_due(here: Here, exercise: Exercise) -> bool:
    """Whether ``course hint`` would give a new one; not where the record cannot be read."""
    return here.known_history(exercise).hint_is_due(fingerprint(here.stub(exercise)))


def after_warm_up(here: Here, warm_up: Exercise) -> str:
    """After a finished warm-up: its report, or what comes next."""
    if (Path(warm_up.folder) / "report.py").is_file():
        return f"course report {warm_up.id}"
    return _after(here, warm_up)


def after_report(here: Here, exercise: Exercise) -> str:
    """Its checks; once they pass, what comes after the exercise."""
    last = here.known_history(exercise).last_graded
    if last is None or not last.all_pass:
        return f"course check {exercise.id}"
    return _after(here, exercise) if exercise.is_warm_up else "course submit"


def _after(here: Here, done: Exercise) -> str:
    standing = Standing()
    with suppress(CourseError):  # a record that cannot be read is warned about elsewhere
        standing = here.standing()
    return next_in_course(here.catalog, standing, done)


#: What is noted of a task that somebody works on.
_WORK = frozenset({"start", "check", "hint"})


def next_task(catalog: Catalog, standing: Standing, done: Exercise | None = None) -> Exercise | None:
    """The task last worked on if it is not done, else the next one; None if all are done.

    A lesson that is read for the first time leads to its tasks. At the end come the exercises that were left
    out. Warm-ups that were left out are left behind.

    Args:
        done: a task to go on from, instead.
    """
    every = catalog.every_task()
    place = every.index(done) + 1 if done is not None else _last_place(every, standing)
    left = [*every[place:], *(one for one in every[:place] if not one.is_warm_up)]
    return next((one for one in left if one is not done and not is_done(standing, one)), None)


def is_done(standing: Standing, task: Exercise) -> bool:
    """Whether all checks passed: of a warm-up once, of an exercise when all were last run."""
    return standing.history(task.id).done is not None if task.is_warm_up else standing.is_complete(task.id)


def _last_place(every: Sequence[Exercise], standing: Standing) -> int:
    names, lessons = [one.id for one in every], [one.lesson for one in every]
    for event in reversed(standing.events()):
        if event.kind in _WORK and event.subject in names and not event.data.get("all"):
            return names.index(event.subject)
        if event.kind == "lesson" and event.subject in lessons and standing.read[event.subject] == event.at:
            return lessons.index(event.subject)
    return 0


def next_in_course(catalog: Catalog, standing: Standing, done: Exercise | None = None) -> str:
    """From anywhere: the next task, a lesson without tasks that was not read, the quiz, or handing in.

    Args:
        done: a task to go on from, instead of the one last worked on.
    """
    if (task := next_task(catalog, standing, done)) is not None:
        return _go_on(standing, task)
    leading = {one.lesson for one in catalog.every_task()}
    unread = (name for name in catalog.lesson_ids() if name not in leading and name not in standing.read)
    if lesson := next(unread, ""):
        return f"course lesson {lesson}"
    if not leading:
        return "course lessons"
    best = standing.quiz.best
    taken = (best is not None and best.passed) or not any(catalog.content.quiz.glob("*.toml"))
    return "course submit" if taken else "course quiz take"


def after_lesson(catalog: Catalog, standing: Standing, lesson: Lesson, *, read: bool) -> str:
    """After a lesson that was read, or else only printed: then its own exercises come first."""
    left = [name for name in lesson.exercises if not standing.is_complete(name)]
    if read or not left:
        return next_in_course(catalog, standing) if read or lesson.exercises else "course lessons"
    return _go_on(standing, catalog.exercise(left[0]))


def _go_on(standing: Standing, task: Exercise) -> str:
    if standing.is_begun(task.id) and standing.has_file(task.place, task.module):
        return f"course check {task.id}"
    return f"course {'warmup' if task.is_warm_up else 'start'} {task.id}"


#: A step in words, by its command.
_WHY = {
    "lesson": "a lesson you have not read to its end",
    "lessons": "everything this course has was read",
    "warmup": "the next small task",
    "start": "the next exercise",
    "quiz": "the quiz",
    "submit": "everything is done: hand it in",
}


def why(catalog: Catalog, step: str) -> str:
    """What a step is, in words."""
    _, name, *rest = step.split()
    if name == "check":
        return f"the {'small task' if rest[0] in catalog.warm_up_ids() else 'exercise'} where you left off"
    return _WHY.get(name, "")


def exercise_ahead(catalog: Catalog, standing: Standing, step: str) -> str:
    """The exercise in progress, or where the next one comes, while ``step`` is about a lesson; else empty."""
    _, kind, *names = step.split()
    a_warm_up = bool(names) and names[0] in catalog.warm_up_ids()
    if kind != "lesson" and not a_warm_up:
        return ""
    if going := _in_progress(catalog, standing):
        return going
    exercise = next((one for one in catalog.exercises() if not standing.is_begun(one.id)), None)
    if exercise is None or exercise.lesson not in catalog.lesson_ids():
        return ""
    after = catalog.lesson_ids().index(exercise.lesson) + 1
    called = f"Exercise {catalog.place_of(exercise)}, {exercise.id},"
    return f"{called} comes after lesson {after}. To start it now: course start {exercise.id}"


def _in_progress(catalog: Catalog, standing: Standing) -> str:
    """The exercise checked last, of those begun and not done, and how to go on; empty without one."""
    begun: list[tuple[str, str]] = []
    for exercise in catalog.exercises():
        if not standing.is_begun(exercise.id) or standing.is_complete(exercise.id):
            continue
        last, graded = standing.history(exercise.id).last, standing.history(exercise.id).last_graded
        points = graded and f"{format_points(graded.score)} of {in_points(graded.max_score)}"
        state = f"in progress, {points}" if points else "started, not checked yet"
        go_on = f"{exercise.id}: {state}. To go on: {_go_on(standing, exercise)}"
        begun.append((last.at.isoformat() if last else "", go_on))
    return max(begun, key=lambda one: one[0])[1] if begun else ""
