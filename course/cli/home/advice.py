"""Which command to suggest next."""

from __future__ import annotations

from pathlib import Path

from course.catalog.load import Catalog
from course.catalog.models import Exercise
from course.cli.frame.here import Here
from course.errors import CourseError
from course.handed_in.attempts import Attempt
from course.progress.history import fingerprint
from course.progress.standing import Standing
from course.scoring.verdict import format_points, in_points


def next_step(here: Here, made: Attempt) -> str:
    """After a check: hand in, take a hint if one is due, or go on working."""
    exercise = made.exercise
    if made.verdict.all_pass:
        return after_warm_up(here, exercise) if exercise.is_warm_up else "course submit"
    if fingerprint(made.source) == fingerprint(here.stub(exercise)):
        return _before_writing(here, exercise)
    return f"course {'hint' if hint_is_due(here, exercise) else 'watch'} {exercise.id}"


def hint_is_due(here: Here, exercise: Exercise) -> bool:
    """Whether ``course hint`` would give a new one; not where the record cannot be read."""
    try:
        return here.history(exercise).hint_is_due(fingerprint(here.stub(exercise)))
    except CourseError:
        return False


def after_warm_up(here: Here, warm_up: Exercise) -> str:
    """After a finished warm-up: its report, or what comes next."""
    if (Path(warm_up.folder) / "report.py").is_file():
        return f"course report {warm_up.id}"
    return _rest_of_lesson(here, warm_up)


def after_report(here: Here, exercise: Exercise) -> str:
    """Its checks; once they pass, what comes after the exercise."""
    try:
        last = here.history(exercise).last_graded
    except CourseError:
        last = None
    if last is None or not last.all_pass:
        return f"course check {exercise.id}"
    return _rest_of_lesson(here, exercise) if exercise.is_warm_up else "course submit"


def _rest_of_lesson(here: Here, warm_up: Exercise) -> str:
    """Its lesson if partly read; otherwise the lesson's next warm-up, the lesson, or what comes next."""
    try:
        standing = here.standing()
        begun = standing.events("bookmark", warm_up.lesson)
        done = {event.subject for event in standing.events("check") if event.data.get("all_pass")}
        read = warm_up.lesson in standing.read
    except CourseError:  # a record that cannot be read is warned about elsewhere
        standing, begun, done, read = Standing(), (), set(), False
    if begun and not read:  # the other warm-ups wait there, each in its place
        return f"course lesson {warm_up.lesson}"
    left = [one.id for one in here.catalog.warm_ups(warm_up.lesson) if one.id not in {*done, warm_up.id}]
    if left:
        return f"course warmup {left[0]}"
    return next_in_course(here.catalog, standing) if read else f"course lesson {warm_up.lesson}"


def next_in_course(catalog: Catalog, standing: Standing) -> str:
    """From anywhere: the first lesson unread or exercise unfinished, in the order of the syllabus."""
    read, started = standing.read, standing.started
    # Warm-ups are offered where the student is now; moving on leaves the rest of them behind.
    furthest = next((name for name in reversed(catalog.lesson_ids()) if name in read), "")
    for lesson in catalog.lessons():
        if not started.intersection(lesson.exercises):
            if lesson.id not in read:
                return f"course lesson {lesson.id}"
            if lesson.id == furthest and (step := _warm_up_step(catalog, standing, lesson.id)):
                return step
        for name in lesson.exercises:
            if name in catalog.exercise_ids() and (step := _exercise_step(standing, name)):
                return step
    for exercise in catalog.exercises():
        if step := _exercise_step(standing, exercise.id):
            return step
    if not started:
        return "course lessons"
    best = standing.quiz.best if any(catalog.content.quiz.glob("*.toml")) else None
    return "course submit" if best is None or best.passed else "course quiz take"


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
    called = f"Exercise {exercise.number}, {exercise.id}," if exercise.number else f"Exercise {exercise.id}"
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
        go_on = f"{exercise.id}: {state}. To go on: course check {exercise.id}"
        begun.append((last.at.isoformat() if last else "", go_on))
    return max(begun, key=lambda one: one[0])[1] if begun else ""


def _warm_up_step(catalog: Catalog, standing: Standing, lesson: str) -> str:
    """The first warm-up of a lesson that is not done; empty if there is none."""
    for warm_up in catalog.warm_ups(lesson):
        if standing.history(warm_up.id).done is None:
            return f"course {'check' if warm_up.id in standing.started else 'warmup'} {warm_up.id}"
    return ""


def _exercise_step(standing: Standing, name: str) -> str:
    if not standing.is_begun(name):
        return f"course start {name}"
    return "" if standing.is_complete(name) else f"course check {name}"


def _before_writing(here: Here, exercise: Exercise) -> str:
    """The step before anything is written: the lesson if it was not read, or the file."""
    if exercise.is_warm_up:  # done while its lesson is read
        return f"course watch {exercise.id}"
    try:
        read = exercise.lesson in here.standing().read
    except CourseError:
        read = True
    return f"course watch {exercise.id}" if read else f"course lesson {exercise.lesson}"
